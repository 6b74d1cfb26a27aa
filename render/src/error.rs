//! What can go wrong while drawing.

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The machine has neither a graphics card with a driver nor a software one.
    #[error(
        "no graphics adapter found: install a Vulkan driver (on Debian, the package mesa-vulkan-drivers has a software one)"
    )]
    NoAdapter,
    /// The only adapter speaks OpenGL.
    #[error(
        "the graphics adapter {0} has OpenGL alone, and Purlwise draws with Vulkan, Metal or Direct3D 12: install a Vulkan driver (on \
         Debian, the package mesa-vulkan-drivers has a software one)"
    )]
    OpenGl(String),
    /// The adapter gave no device.
    #[error("the graphics adapter gave no device: {0}")]
    Device(#[from] wgpu::RequestDeviceError),
    /// The picture is larger than the adapter's textures.
    #[error(
        "a picture of {width}×{height} pixels is outside 1…{limit}, the sizes that this adapter can draw"
    )]
    Size {
        /// Width asked for [px].
        width: u32,
        /// Height asked for [px].
        height: u32,
        /// Largest width and height [px].
        limit: u32,
    },
    /// The data needs more memory in one buffer than the adapter has.
    #[error("{what} need {bytes} bytes in one buffer, and this adapter allows {limit}")]
    TooLarge {
        /// What the buffer holds.
        what: &'static str,
        /// Size asked for.
        bytes: u64,
        /// Largest size.
        limit: u64,
    },
    /// The picture could not be read back.
    #[error("the picture could not be read back: {0}")]
    ReadBack(String),
}
