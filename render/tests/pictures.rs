//! Whole pictures: known scenes checked by their pixels, and pictures to look at in the target directory.

mod support;

use glam::Vec3;
use render::{Camera, Drawing, NamedView, Solid, Solids, render_image};
use support::{gpu, stockinette};

fn save(name: &str, picture: &image::RgbaImage) {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    picture.save(&path).unwrap();
    println!("{}", path.display());
}

#[test]
#[ignore = "draws pictures to look at; checks nothing"]
fn gallery() {
    let size = [1280, 960];
    let aspect = 4.0 / 3.0;
    let fabric = |wales, courses| Drawing { yarn: stockinette(wales, courses), ..Default::default() };
    let swatch = fabric(24, 26);
    let camera = Camera::named(NamedView::Front, swatch.bounds().unwrap(), aspect);
    save("front.png", &render_image(gpu(), size, &camera, &swatch).unwrap());
    let camera = Camera::named(NamedView::Back, swatch.bounds().unwrap(), aspect);
    save("back.png", &render_image(gpu(), size, &camera, &swatch).unwrap());
    let near = Camera { distance: 0.045, yaw: 0.4, pitch: 0.35, ..camera };
    save("near.png", &render_image(gpu(), size, &near, &swatch).unwrap());
    let mut draped = fabric(63, 63);
    draped.solids = Solids {
        solids: vec![
            Solid::Ground { height: -0.16 },
            Solid::Sphere { center: Vec3::new(0.02, -0.06, -0.11), radius: 0.1 },
        ],
    };
    let camera = Camera::named(NamedView::ThreeQuarter, draped.bounds().unwrap(), aspect);
    save("far.png", &render_image(gpu(), size, &camera, &draped).unwrap());
}
