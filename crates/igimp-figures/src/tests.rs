//! Whole figures: well-formed, complete, of the right size, and never a panic.

use super::*;

const NASTY: [f64; 9] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    1e308,
    -1e308,
    1e-320,
    0.0,
    -1.0,
    3.0,
];

fn square(x: f64, y: f64, side: f64) -> Polygon {
    vec![[x, y], [x + side, y], [x + side, y + side], [x, y + side]]
}

/// A field on `n` × `n` unit squares.
fn squares(n: u32) -> FieldPlot {
    let cells = || (0..n).flat_map(|i| (0..n).map(move |j| (f64::from(i), f64::from(j))));
    FieldPlot {
        title: "Squares".into(),
        domains: cells().map(|(x, y)| square(x, y, 1.0)).collect(),
        values: cells().map(|(x, y)| x + y).collect(),
        label: "sum x + y [m]".into(),
        ..FieldPlot::default()
    }
}

fn curve() -> CurvePlot {
    CurvePlot {
        title: "Stress & strain".into(),
        x_label: "ε_{yy} [−]".into(),
        y_label: "σ_{yy} [kPa]".into(),
        bands: vec![Band::around("±5 %", &[[0.0, 0.0], [1.0, 10.0]], 0.05)],
        lines: vec![ReferenceLine {
            label: "limit".into(),
            at: ReferenceValue::Y(9.0),
        }],
        series: vec![
            Series::line("exact", vec![[0.0, 0.0], [1.0, 10.0]]).in_colour(Colour::BLACK),
            Series::markers("computed", vec![[0.1, 1.0], [0.5, 5.2], [0.9, 8.8]]),
        ],
        ..CurvePlot::default()
    }
}

/// Checks that tags nest and close, attributes are quoted, and no sign is left unescaped.
fn assert_well_formed(svg: &str) {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = svg;
    while let Some(start) = rest.find('<') {
        let text = &rest[..start];
        assert!(!text.contains('>'), "stray > in {text:?}");
        let end = start + rest[start..].find('>').expect("a tag ends");
        let tag = &rest[start + 1..end];
        assert_eq!(
            tag.matches('"').count() % 2,
            0,
            "unquoted attribute in <{tag}>"
        );
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(tag.split_whitespace().next().expect("a tag has a name"));
        }
        rest = &rest[end + 1..];
    }
    assert!(open.is_empty(), "left open: {open:?}");
    let entities = svg.matches('&').count();
    let known = ["&amp;", "&lt;", "&gt;"].map(|entity| svg.matches(entity).count());
    assert_eq!(entities, known.iter().sum::<usize>());
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
}

fn png_size(bytes: &[u8]) -> (u32, u32) {
    let reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    reader.info().size()
}

#[test]
fn svg_is_well_formed() {
    assert_well_formed(&curve().draw().unwrap().to_svg());
    assert_well_formed(&squares(4).draw().unwrap().to_svg());
}

#[test]
fn svg_holds_every_domain_and_one_path_per_colour() {
    let svg = squares(10).draw().unwrap().to_svg();
    // Domains, bar colours, and two frames are closed; 19 different sums make 19 paths.
    let paths = || svg.lines().filter(|line| line.starts_with("<path"));
    let closed: usize = paths().map(|path| path.matches('z').count()).sum();
    assert_eq!(closed, 100 + crate::field::colour_bar::LEVELS + 2);
    let filled = paths().filter(|path| path.contains("fill=\"#")).count();
    assert_eq!(filled, 19 + crate::field::colour_bar::LEVELS);
}

#[test]
fn svg_holds_every_marker_and_label() {
    let svg = curve().draw().unwrap().to_svg();
    let markers = svg
        .lines()
        .find(|line| line.contains("stroke-width=\"0.5\""))
        .unwrap();
    assert_eq!(markers.matches('z').count(), 3);
    for label in [
        "exact",
        "computed",
        "±5 %",
        "limit",
        "Stress &amp; strain",
        ">yy<",
    ] {
        assert!(svg.contains(label), "{label} is missing");
    }
}

#[test]
fn png_has_three_pixels_per_point() {
    let drawing = squares(3).draw().unwrap();
    let size = png_size(&drawing.to_png().unwrap());
    assert_eq!(size, drawing.pixel_size());
    assert!(size.0.abs_diff(640 * PIXELS_PER_POINT) <= 3, "{size:?}");
    assert_eq!(
        png_size(&curve().draw().unwrap().to_png().unwrap()),
        (1920, 1290)
    );
}

#[test]
fn neighbouring_domains_leave_no_seam() {
    // Equal values on odd-sized cells: every pixel well inside must have the one colour.
    let mut plot = squares(37);
    plot.values.fill(1.0);
    let bytes = plot.draw().unwrap().to_png().unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    let row_length = 3 * info.width as usize;
    let row = &pixels[row_length * (info.height as usize / 2)..][..row_length];
    let inside: Vec<&[u8]> = row.chunks(3).skip(300).take(900).collect();
    assert!(inside.iter().all(|&pixel| pixel == inside[0]));
}

#[test]
fn both_files_are_written_and_keep_dots_in_their_name() {
    let folder = std::env::temp_dir().join(format!("igimp-figures-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    curve().write(&folder.join("srf-1.25")).unwrap();
    let svg = std::fs::read_to_string(folder.join("srf-1.25.svg")).unwrap();
    assert_well_formed(&svg);
    assert!(folder.join("srf-1.25.png").exists());
    std::fs::remove_dir_all(&folder).unwrap();
    let error = curve().write(&folder.join("gone")).unwrap_err();
    assert!(matches!(error, FigureError::Write { .. }), "{error}");
}

#[test]
fn domains_without_value_are_grey_and_counted() {
    let mut plot = squares(4);
    plot.values[5] = f64::NAN;
    let svg = plot.draw().unwrap().to_svg();
    assert!(svg.contains("fill=\"#a8a8a8\""));
    assert!(svg.contains("no value (grey): 1 of 16 domains"));
}

#[test]
fn nasty_numbers_never_panic() {
    let points: Vec<[f64; 2]> = NASTY.iter().flat_map(|&x| NASTY.map(|y| [x, y])).collect();
    for scale in [Scale::Linear, Scale::Log] {
        for part in [&points[..], &points[..1], &points[60..], &[]] {
            let plot = CurvePlot {
                x_scale: scale,
                y_scale: scale,
                bands: vec![Band::around("band", part, 0.1)],
                lines: NASTY
                    .map(|x| ReferenceLine {
                        label: "x".into(),
                        at: ReferenceValue::X(x),
                    })
                    .into(),
                series: vec![Series::new(
                    "s",
                    part.to_vec(),
                    SeriesStyle::LineAndMarkers(LineStyle::Dashed),
                )],
                ..CurvePlot::default()
            };
            let drawing = plot.draw().unwrap();
            assert_well_formed(&drawing.to_svg());
            drawing.to_png().unwrap();
        }
    }
    for map in [ColourMap::Sequential, ColourMap::Diverging] {
        let domains: Vec<Polygon> = points.iter().map(|&[x, y]| square(x, y, 1.0)).collect();
        let values = domains
            .iter()
            .enumerate()
            .map(|(k, _)| NASTY[k % 9])
            .collect();
        let plot = FieldPlot {
            domains,
            values,
            map,
            ..FieldPlot::default()
        };
        let drawing = plot.draw().unwrap();
        assert_well_formed(&drawing.to_svg());
        drawing.to_png().unwrap();
    }
}

#[test]
fn empty_figures_say_so() {
    assert!(
        CurvePlot::default()
            .draw()
            .unwrap()
            .to_svg()
            .contains("no data")
    );
    assert!(
        FieldPlot::default()
            .draw()
            .unwrap()
            .to_svg()
            .contains("no data")
    );
}

#[test]
fn wrong_input_is_refused_by_name() {
    let mut plot = squares(2);
    plot.values.pop();
    let error = plot.draw().unwrap_err();
    assert_eq!(
        error.to_string(),
        "figure \"Squares\": 4 domains but 3 values"
    );
    let plot = FieldPlot {
        range: Some((1.0, 1.0)),
        ..squares(2)
    };
    assert!(matches!(
        plot.draw(),
        Err(FigureError::InvalidRange {
            axis: "colour bar",
            ..
        })
    ));
    let plot = CurvePlot {
        x_scale: Scale::Log,
        x_range: Some((0.0, 1.0)),
        ..curve()
    };
    assert!(matches!(
        plot.draw(),
        Err(FigureError::InvalidRange { axis: "x axis", .. })
    ));
    let panel = FieldPanel {
        title: "P".into(),
        columns: 2,
        plots: Vec::new(),
    };
    assert!(matches!(panel.draw(), Err(FigureError::EmptyPanel { .. })));
    let other = FieldPlot {
        label: "other".into(),
        ..squares(2)
    };
    let panel = FieldPanel {
        title: "P".into(),
        columns: 2,
        plots: vec![squares(2), other],
    };
    assert!(matches!(panel.draw(), Err(FigureError::MixedPanel { .. })));
}

#[test]
fn a_key_takes_the_place_of_the_colour_bar() {
    let mut plot = squares(2);
    plot.values = vec![0.0, 1.0, 1.0, f64::NAN];
    plot.labels = vec![([1.0, 1.0], "here".into()), ([50.0, 1.0], "outside".into())];
    let entry = |sample, label: &str| KeyEntry {
        sample,
        label: label.into(),
    };
    plot.key = vec![
        entry(KeySample::Value(0), "clay"),
        entry(KeySample::Value(1), "sand"),
    ];
    for style in [
        OutlineStyle::Edge,
        OutlineStyle::Grid,
        OutlineStyle::Section,
        OutlineStyle::Block,
        OutlineStyle::Fixed,
        OutlineStyle::Roller,
        OutlineStyle::Arrow,
        OutlineStyle::Point,
        OutlineStyle::Water,
    ] {
        plot.key
            .push(entry(KeySample::Outline(style), &format!("{style:?}")));
        for points in [vec![[0.0, 0.0], [1.5, 1.0]], vec![[1.0, 1.0]], Vec::new()] {
            plot.outlines.push(Outline { points, style });
        }
    }
    let drawing = plot.draw().unwrap();
    drawing.to_png().unwrap();
    let svg = drawing.to_svg();
    assert_well_formed(&svg);
    for text in ["clay", "sand", "Roller", "here"] {
        assert!(svg.contains(&format!(">{text}<")), "{text} is missing");
    }
    assert!(!svg.contains("sum x + y") && !svg.contains("outside"));
}

#[test]
fn a_panel_shares_range_and_bar() {
    let large = FieldPlot {
        values: vec![10.0; 4],
        ..squares(2)
    };
    let plots = vec![squares(2), squares(2), large];
    let svg = FieldPanel {
        title: "Panel".into(),
        columns: 2,
        plots,
    }
    .draw()
    .unwrap()
    .to_svg();
    assert_eq!(svg.matches("sum x + y [m]").count(), 1);
    assert_eq!(svg.matches(">Squares<").count(), 3);
    assert!(svg.contains(">10<"));
}

#[test]
fn a_break_that_was_asked_for_is_no_hidden_point() {
    let note = |point: [f64; 2]| {
        let mut plot = curve();
        plot.series[0].points.insert(1, point);
        plot.draw().unwrap().to_svg().contains("points not shown")
    };
    assert!(!note([f64::NAN; 2]));
    assert!(note([0.5, f64::NAN]));
}
