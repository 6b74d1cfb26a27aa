# Sourced by ./run and ./check: installs what the program needs from the system, where it is missing and apt-get is at hand.
# With the argument "window" also what a window needs.

# Packages by the library that shows they are there. Libraries are opened when the program runs, so none is needed to build.
missing=()
need() { # LIBRARY PACKAGE…
    [[ $libraries == *"$1"* ]] || missing+=("${@:2}")
}

if [[ $(uname) == Linux ]]; then
    # On Debian, ldconfig is not on the path of people other than root.
    libraries=$(PATH=$PATH:/sbin:/usr/sbin ldconfig -p)
    need libvulkan.so.1 libvulkan1
    # Vulkan's loader does nothing without a driver: this one draws on the processor where there is no other.
    compgen -G "/usr/share/vulkan/icd.d/*" >/dev/null || compgen -G "/etc/vulkan/icd.d/*" >/dev/null ||
        missing+=(mesa-vulkan-drivers)
    command -v cc >/dev/null || missing+=(gcc libc6-dev) # cargo links with it
    if [[ ${1:-} == window && -n ${DISPLAY:-} ]]; then
        need libxkbcommon-x11.so.0 libxkbcommon-x11-0
        need libX11-xcb.so.1 libx11-xcb1
        need libXcursor.so.1 libxcursor1
        need libXi.so.6 libxi6
    fi
    if [[ ${1:-} == window && -n ${WAYLAND_DISPLAY:-} ]]; then
        need libwayland-client.so.0 libwayland-client0
        need libxkbcommon.so.0 libxkbcommon0
    fi
    if ((${#missing[@]})) && command -v apt-get >/dev/null; then
        echo "Installing ${missing[*]}" >&2
        as_root=()
        ((EUID == 0)) || as_root=(sudo)
        "${as_root[@]}" apt-get update -qq
        "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
    elif ((${#missing[@]})); then
        echo "Not found, and no apt-get to install it with (names as in Debian): ${missing[*]}" >&2
    fi
fi

if ! command -v cargo >/dev/null; then
    echo "cargo is missing: install Rust as https://rustup.rs says" >&2
    exit 1
fi

# Mesa complains on every start where this is unset.
if [[ -z ${XDG_RUNTIME_DIR:-} ]]; then
    runtime_dir=$(mktemp -d)
    trap 'rm -rf "$runtime_dir"' EXIT
    export XDG_RUNTIME_DIR=$runtime_dir
fi
