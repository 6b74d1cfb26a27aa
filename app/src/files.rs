//! Reading and writing files: errors name the file, and nothing is overwritten until its replacement is whole.

use anyhow::{Context, Result, bail};
use std::io::Write as _;
use std::path::Path;

/// Reads a whole file.
pub fn read(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))
}

/// Writes a whole file or nothing: into a temporary file beside it first, which then takes its place.
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let write = || -> std::io::Result<()> {
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut file = tempfile::NamedTempFile::new_in(folder)?;
        file.write_all(bytes)?;
        file.as_file().sync_all()?;
        // A temporary file is private to its owner; a document is not.
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt as _;
            file.as_file().set_permissions(std::fs::Permissions::from_mode(0o644))?;
        }
        file.persist(path)?;
        Ok(())
    };
    write().with_context(|| format!("cannot write {}", path.display()))
}

/// Checks that a name does not say that a file is of another kind than `what`, which have an `ending` of their own.
pub fn check_ending(path: &Path, ending: &str, what: &str) -> Result<()> {
    match path.extension().filter(|other| !other.eq_ignore_ascii_case(ending)) {
        Some(other) => {
            bail!("{}: {what} are written as .{ending}, not as .{}", path.display(), other.display())
        }
        None => Ok(()),
    }
}

/// Writes a picture as PNG, whole or not at all; not under the name of another kind of file.
pub fn write_png(path: &Path, image: &image::RgbaImage) -> Result<()> {
    check_ending(path, "png", "pictures")?;
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png)?;
    write(path, bytes.get_ref())
}

/// Writes a drawn page as a PNG of 256 colours, compressed as well as it goes: a third of what all colours take.
pub fn write_small_png(path: &Path, image: &image::RgbaImage) -> Result<()> {
    /// One in so many pixels is looked at for the colours.
    const SAMPLED: i32 = 10;
    let colors = color_quant::NeuQuant::new(SAMPLED, 256, image.as_raw());
    let pixels: Vec<u8> = image.pixels().map(|pixel| colors.index_of(&pixel.0) as u8).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.width(), image.height());
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_palette(colors.color_map_rgb());
    encoder.set_compression(png::Compression::High);
    // The neighbours of an index say nothing about it.
    encoder.set_filter(png::Filter::NoFilter);
    encoder.write_header()?.write_image_data(&pixels)?;
    write(path, &bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_has_the_name_of_what_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let image = image::RgbaImage::new(2, 2);
        for (name, is_written) in [("a.png", true), ("b.PNG", true), ("c", true), ("d.bmp", false)] {
            let path = folder.path().join(name);
            let written = write_png(&path, &image);
            assert_eq!(written.is_ok(), is_written, "{name}");
            assert_eq!(path.exists(), is_written);
            assert!(is_written || written.unwrap_err().to_string().contains("d.bmp"));
        }
    }
}
