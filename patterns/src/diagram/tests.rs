//! Charts of small pieces of fabric.

use super::mark::{Ink, Paint};
use super::*;
use stitch_mesh::edge_counts::StitchSize;
use stitch_mesh::pieces::{from_rows, tube};
use stitch_mesh::{catalogue, swatches};

fn piece(rows: &[&str]) -> StitchMesh {
    let row = |text: &&str| text.split_whitespace().map(|s| s.parse().unwrap()).collect();
    from_rows(&rows.iter().map(row).collect::<Vec<_>>(), StitchSize::of_width(3e-3)).unwrap()
}

fn chart(stitches: &StitchMesh) -> Diagram {
    Diagram::of(stitches, &Course::piece(stitches, &stitches.rows()), [60, 80])
}

/// The rows as text, the lowest first; a dot is no stitch, a comma a further square of the same cell.
fn text(diagram: &Diagram) -> Vec<String> {
    let cell = |c: &Cell| {
        let symbol = c.stitch.as_ref().map_or(".".to_owned(), Stitch::abbreviation);
        format!("{symbol}{}", ",".repeat(c.columns.len() - 1))
    };
    let row = |r: &DiagramRow| r.cells.iter().map(cell).collect::<Vec<_>>().join(" ");
    diagram.rows.iter().map(row).collect()
}

#[test]
fn a_rib_has_a_square_a_stitch_and_repeats() {
    let chart = chart(&piece(&["k k p p k k p p", "k k p p k k p p"]));
    assert_eq!(text(&chart), ["k k p p k k p p"; 2]);
    assert_eq!(chart.repeat, Some(Repeat { columns: 4..8, rows: 0..1 }));
    let sides: Vec<(usize, bool)> = chart.rows.iter().map(|r| (r.number, r.right_side)).collect();
    assert_eq!(sides, [(1, true), (2, false)]);
    assert_eq!(chart.left_out(), None);
}

#[test]
fn lace_keeps_its_columns() {
    let chart = chart(&piece(&["k k k k k k", "k d12k yk ky k", "k k k k k k k"]));
    assert_eq!(text(&chart), ["k k k k k . k", "k k2tog yo k k yo k", "k k k k k k k"]);
    let whole = piece(&["k k k k k k k", "k d12k yk k d21k d0y", "k k k k k k k"]);
    let lace = self::chart(&whole);
    assert_eq!(text(&lace)[1], "k k2tog yo k k ssk yo");
    let faces: Vec<_> = lace.rows[1].cells.iter().map(|c| c.face.unwrap()).collect();
    assert_eq!(faces[2], faces[3], "a yarn-over and the stitch beside it are one face");
}

#[test]
fn what_was_taken_together_leaves_its_square() {
    let chart = chart(&piece(&["k k k k k", "k d231k k", "k k k", "kyk k kpk"]));
    assert_eq!(text(&chart)[..3], [". k k k k k .", ". k . s2kp . k .", ". k . k . k ."].map(str::to_owned));
    assert_eq!(text(&chart)[3], "k-yo-k,, k k-p-k,,");
}

#[test]
fn a_piece_grows_from_its_middle() {
    let chart = chart(&piece(&["k", "yky", "k k k", "yk k ky"]));
    assert_eq!(text(&chart), [". . k . .", ". yo k yo .", ". k k k .", "yo k k k yo"]);
}

#[test]
fn cables_lie_over_the_row_that_they_are_knitted_into() {
    let cable = Cable::cross(Vec::new(), 2, 2, true);
    let fabric = swatches::of_cable(&[(0, cable)], 4, StitchSize::of_width(3e-3)).unwrap();
    let chart = chart(&fabric);
    let [crossing] = &chart.crossings[..] else { panic!("{:?}", chart.crossings) };
    assert_eq!((crossing.columns.clone(), &crossing.front[..]), (2..6, &[1, 0][..]));
    assert_eq!(crossing.name(), "cable: 2 over 2, to the left");
    assert!(crossing.row > 0);
}

#[test]
fn dots_of_a_purled_strand_are_not_covered() {
    let crossing = |front: [u8; 2]| Crossing {
        row: 0,
        columns: 0..4,
        strands: vec![2, 2],
        order: vec![1, 0],
        front: front.to_vec(),
        purled: vec![front[0] == 1, front[0] == 0],
    };
    for front in [[1, 0], [0, 1]] {
        let marks = glyph::of_crossing(&crossing(front));
        let size = [4.0, 1.0];
        let picture = raster::draw(&sheet::Sheet { size, marks }, 40.0).unwrap();
        // Along the line of the dots: two of them, apart from the three sides of strands that show.
        let black: Vec<bool> = (0..160).map(|x| picture.rgba[4 * (8 * 160 + x)] < 0x80).collect();
        assert_eq!(black.windows(2).filter(|w| !w[0] && w[1]).count(), 3 + 2, "{front:?}");
    }
}

#[test]
fn symbols_stay_in_their_squares() {
    for symbol in catalogue::symbols() {
        for (stitch, _) in split(&symbol.parse().unwrap()) {
            let wide = stitch.tops().max(1) as f32;
            let marks = glyph::of(&stitch);
            assert!(!marks.is_empty() || stitch == Stitch::knit(), "{symbol}");
            for [x, y] in marks.iter().flat_map(|m| &m.points) {
                assert!((0.0..=wide).contains(x) && (0.0..=1.0).contains(y), "{symbol} at {x}, {y}");
            }
        }
    }
}

#[test]
fn rows_that_go_round_are_all_right_side_rows() {
    let chart = chart(&tube(7, 3, StitchSize::of_width(3e-3)).unwrap());
    assert!(chart.rows.iter().all(|r| r.right_side) && chart.repeat.is_none());
}

#[test]
fn what_is_too_large_is_cut_and_says_so() {
    let stitches = piece(&["k k p k k"; 4]);
    let chart = Diagram::of(&stitches, &Course::piece(&stitches, &stitches.rows()), [3, 2]);
    assert_eq!(text(&chart), ["k k p"; 2]);
    assert_eq!(chart.left_out().unwrap(), "the first 3 of 5 stitches, the first 2 of 4 rows");
    let around = Course::around(&stitches, &stitches.rows(), &[FaceId(6), FaceId(12)].into());
    let faces: Vec<_> = around.iter().map(|c| (c.number, c.faces.clone())).collect();
    assert_eq!(faces, [(2, vec![FaceId(6), FaceId(7)]), (3, vec![FaceId(11), FaceId(12)])]);
}

#[test]
fn pieces_side_by_side_count_their_rows_alike() {
    let [one, other] = ["k k", "p p p"].map(|row| piece(&[row; 3]));
    let (a, b) = (one.mesh(), other.mesh());
    let positions = a.positions().iter().chain(b.positions()).copied().collect();
    let moved = b.face_lists().into_iter().map(|f| f.iter().map(|v| v + a.vertex_count() as u32).collect());
    let faces: Vec<Vec<u32>> = a.face_lists().into_iter().chain(moved).collect();
    let mesh = stitch_mesh::mesh::PolygonMesh::new(positions, &faces).unwrap();
    let both = StitchMesh::new(mesh, [one.stitches(), other.stitches()].concat()).unwrap();
    let all: Vec<usize> = Course::all(&both, &both.rows()).iter().map(|c| c.number).collect();
    assert_eq!(all, [1, 1, 2, 2, 3, 3]);
    assert_eq!(text(&chart(&both)), ["k k"; 3]);
}

#[test]
fn a_place_of_the_drawing_is_a_cell() {
    let chart = chart(&piece(&["k k k", "k kp k"]));
    for (row, cell) in chart.cells() {
        let [x, y] = chart.corner(row, cell.columns.start);
        let found = chart.cell_at([x + cell.columns.len() as f32 - 0.1, y + 0.5]);
        assert_eq!(found, Some(cell));
    }
    assert_eq!(chart.cell_at([0.1, 0.6]), None);
    assert_eq!(chart.cell_at([3.0, 99.0]), None);
}

#[test]
fn the_svg_is_whole_and_names_what_it_shows() {
    let sheet = chart(&piece(&["k k k k", "k d12k yk"])).sheet();
    let svg = svg::to_svg(&sheet);
    assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
    assert_eq!(svg.matches("<path ").count(), sheet.marks.len());
    assert_eq!(svg.matches('<').count(), svg.matches('>').count());
    assert_eq!(
        svg.matches("<path ").count(),
        svg.matches("Z\" fill").count() + svg.matches(" fill=\"none\"").count()
            - svg.matches("Z\" fill=\"none\"").count()
    );
    assert!(!svg.contains("NaN"));
    let names: Vec<String> = ["k", "d12k", "d0y"].map(|s| sheet::name(&s.parse().unwrap())).into();
    assert_eq!(
        names,
        ["k: knit", "k2tog: knit two together, leaning right", "yo: yarn-over between two stitches"]
    );
}

#[test]
fn a_purl_is_a_dot_in_the_middle_of_its_square() {
    let chart = chart(&piece(&["k p"]));
    let picture = raster::draw(&chart.sheet(), 20.0).unwrap();
    let pixel = |[x, y]: [f32; 2]| {
        let at = 4 * ((20.0 * y) as usize * picture.size[0] as usize + (20.0 * x) as usize);
        picture.rgba[at]
    };
    let middle = |column| chart.corner(0, column).map(|c| c + 0.5);
    assert_eq!((pixel(middle(0)), pixel(middle(1))), (0xff, 0x18));
    let [x, y] = middle(1);
    assert_eq!(pixel([x + 0.3, y]), 0xff, "beside the dot");
    assert_eq!(raster::draw(&chart.sheet(), 1e5), None);
}

#[test]
fn dyed_yarn_shows_in_the_squares_and_in_the_legend() {
    let plain = piece(&["p p p p", "k k k k", "p p p p", "k k k k"]);
    let [dark, light] = [[0x30, 0x30, 0x34], [0xe6, 0x9f, 0x00]].map(Dye);
    let mut dyed = plain.clone();
    for (row, dye) in [(0, dark), (2, light)] {
        plain.rows()[row].faces.iter().for_each(|f| dyed.set_dye(*f, dye).unwrap());
    }
    let (plain, dyed) = (chart(&plain), chart(&dyed));
    let filled = |ink| dyed.marks().iter().filter(|m| m.paint == Paint::Fill(ink)).count();
    assert_eq!([dark, light].map(|dye| filled(Ink::Yarn(dye.0))), [4, 4]);
    assert_eq!([Ink::White, Ink::Black].map(filled), [4, 4], "dots of purls, white where the yarn is dark");
    let legend = |diagram: &Diagram| diagram.sheet().marks.len() - diagram.marks().len();
    assert!(legend(&dyed) > legend(&plain), "the colours are named");
    assert_eq!(plain.repeat.map(|r| r.rows), Some(0..2));
    assert_eq!(dyed.repeat.map(|r| r.rows), Some(0..4));
}
