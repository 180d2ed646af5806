//! GOAL: a results folder becomes a page that stands alone, escapes its text, and reads well
//! after a run that failed. The pages stay in the `tmp` folder of the target, to be looked at.

mod example;
mod findings;

use std::path::Path;

use igimp_assembly::Particles;
use igimp_model::{Field, ReferenceValues, TitleBlock};
use igimp_report::ReportError;
use igimp_report::patches::Pieces;
use igimp_report::pictures::{self, Canvas, Seen, Shown};
use igimp_report::report::write_report;
use igimp_report::setup;
use igimp_report::viewer::Surroundings;
use igimp_results::ResultsError;
use igimp_results::fields::Axes;
use igimp_results::summary::{FigureNote, SafetySummary, SetupTable, StageOutcome, Summary};
use igimp_results::tables::table::Table;

fn page(folder: &Path) -> String {
    let path = write_report(folder, &Surroundings::default()).unwrap();
    assert_eq!(path, folder.join("report.html"));
    std::fs::read_to_string(path).unwrap()
}

/// The text of a page without its tags.
fn words(page: &str) -> String {
    let body = page.split_once("<body>").unwrap().1;
    let mut text = String::new();
    for part in body.split('<') {
        text.push_str(part.split_once('>').map_or(part, |(_, after)| after));
        text.push(' ');
    }
    let words: Vec<_> = text.split_whitespace().collect();
    words.join(" ").replace("&#x2f;", "/")
}

/// Nothing is fetched: sources are data, links are relative.
fn assert_stands_alone(page: &str) {
    for outside in [
        "http:",
        "https:",
        "<script",
        "<link",
        "@import",
        "url(",
        "javascript:",
    ] {
        assert!(!page.contains(outside), "{outside}");
    }
    let values = |attribute: &str| {
        let start = format!(" {attribute}=\"");
        let pieces = page.split(&start).skip(1);
        pieces
            .map(|piece| piece.split('"').next().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    for source in values("src") {
        assert!(source.starts_with("data:image/"), "{source}");
    }
    for link in values("href") {
        let relative = link.starts_with('#') || !link.contains(':') && !link.starts_with('/');
        assert!(relative, "{link}");
    }
    let mut ids = values("id");
    let count = ids.len();
    ids.sort();
    ids.dedup();
    assert_eq!(ids.len(), count, "an id stands twice");
}

#[test]
fn a_run_makes_a_whole_page() {
    let folder = example::folder("whole");
    let case = example::case();
    let summary = Summary {
        figures: example::draw(&folder, &case),
        ..findings::summary()
    };
    example::write(&folder, &summary);
    for note in &summary.figures {
        for extension in ["svg", "png"] {
            let file = folder.join(format!("{}.{extension}", note.file));
            assert!(
                std::fs::metadata(&file).unwrap().len() > 500,
                "{}",
                file.display()
            );
        }
    }
    let page = page(&folder);
    assert_stands_alone(&page);
    let words = words(&page);
    for expected in [
        "Reference missed",
        "1 of 2 checks fails: settlement of the crest [mm] is 21.3, expected 20 (± 5 %).",
        "The factor of safety lies between 1.375 and 1.383.",
        "Strength was reduced in clay, not in rock.",
        "27 % of the mass moves",
        "10 240",
        "curves/load-settlement.csv",
    ] {
        assert!(words.contains(expected), "{expected} is missing in {words}");
    }
    // Pictures of the summary, and the convergence of two stages.
    assert_eq!(page.matches("<img ").count(), summary.figures.len() + 2);
    let order = [
        "id=\"model\"",
        "id=\"curves\"",
        "id=\"fields\"",
        "id=\"tables\"",
        "id=\"input\"",
        "id=\"effort\"",
        "id=\"convergence\"",
    ];
    let places: Vec<_> = order.iter().map(|id| page.find(id).unwrap()).collect();
    assert!(places.is_sorted(), "{places:?}");
    assert!(
        page.contains("<td class=\"n\">31</td>"),
        "rows of the curve are counted"
    );
}

/// GOAL: reader, date and input stand in the head; the results of an engineer
/// stand before the effort of the computer; tables hold the model.
#[test]
fn a_report_can_be_handed_on() {
    let folder = example::folder("handed-on");
    let case = example::case();
    let mut summary = Summary {
        title_block: TitleBlock {
            project: Some("Bypass B12".into()),
            client: Some("Road Authority".into()),
            author: Some("A. Engineer".into()),
            revision: Some("B".into()),
        },
        date: Some("2026-03-01 14:05 UTC".into()),
        input_sha256: Some("c0ffee".into()),
        setup: setup::tables(&case),
        ..findings::summary()
    };
    summary.stages[1].peak_resistance = Some(512e3);
    summary.stages[1].settlement = Some(0.05);
    example::write(&folder, &summary);
    let page = page(&folder);
    assert_stands_alone(&page);
    let text = words(&page);
    for expected in [
        "Project Bypass B12",
        "Client Road Authority",
        "Author A. Engineer",
        "Revision B",
        "Date of the run 2026-03-01 14:05 UTC",
        "Input, SHA-256 c0ffee",
        "Factor of safety 1.375 … 1.383 mesh error not known: igimp run --meshes 2 finds it",
        "Peak resistance 512 kN/m",
        "Settlement 50 mm",
        "Checks met 1 of 2",
        "c = 10 kPa, φ = 20°, ψ = 0°",
        "rigid footing, rough",
        "anchor fixed",
    ] {
        assert!(text.contains(expected), "{expected} is missing in {text}");
    }
    let place = |phrase: &str| {
        text.find(phrase)
            .unwrap_or_else(|| panic!("{phrase} is missing"))
    };
    assert!(place("Factor of safety 1.375") < place("Newton iterations"));
    assert!(place("Materials Material") < place("Newton iterations"));
    // Nothing is folded away that a printer would then leave out.
    assert_eq!(
        page.matches("<details").count(),
        page.matches("<details open").count()
    );
}

#[test]
fn everything_is_escaped() {
    let folder = example::folder("hostile");
    let nasty = "</title><script>alert('1')</script>\"><img src=x onerror=alert(1)>";
    let mut summary = findings::summary();
    summary.title = nasty.into();
    summary.method = nasty.into();
    summary.program = nasty.into();
    summary.title_block.project = Some(nasty.into());
    summary.setup = vec![SetupTable {
        title: nasty.into(),
        header: vec![nasty.into()],
        rows: vec![vec![nasty.into()]],
    }];
    summary.warnings = vec![nasty.into()];
    for stage in &mut summary.stages {
        (stage.name, stage.kind, stage.reason) = (nasty.into(), nasty.into(), nasty.into());
    }
    let safety = summary.stages[2].safety.as_mut().unwrap();
    (safety.criterion, safety.materials) = (nasty.into(), vec![nasty.into()]);
    safety.trials[0].reason = nasty.into();
    for row in &mut summary.checks {
        (row.check.quantity, row.check.source) = (nasty.into(), nasty.into());
        (row.check.case, row.check.variant) = (nasty.into(), nasty.into());
    }
    summary.figures = vec![FigureNote {
        file: format!("figures/{nasty}"),
        caption: nasty.into(),
    }];
    example::write(&folder, &summary);
    std::fs::write(folder.join("case.toml"), nasty).unwrap();
    let columns = format!("a{nasty},b\n1,2\n");
    std::fs::write(folder.join("curves/x&y.csv"), columns).unwrap();
    let page = page(&folder);
    assert_stands_alone(&page);
    assert!(!page.contains("<img src=x") && !page.contains("alert('1')"));
    assert!(page.contains("curves&#x2f;x%26y.csv"));
}

#[test]
fn a_failed_run_says_where_and_why() {
    let folder = example::folder("failed");
    let mut summary = findings::summary();
    summary.checks.clear();
    summary.warnings.clear();
    summary.stages.truncate(2);
    let last = &mut summary.stages[1];
    (last.outcome, last.reached) = (StageOutcome::NotConverged, 0.28);
    last.reason = "step 57 of 200 stagnates after 5 cuts near (31.5, 10.5) m.".into();
    last.plastic_share = f64::NAN;
    summary.figures = vec![FigureNote {
        file: "figures/gone".into(),
        caption: "Not there.".into(),
    }];
    example::write(&folder, &summary);
    let page = page(&folder);
    assert_stands_alone(&page);
    let words = words(&page);
    for expected in [
        "Not converged",
        "Stage “surcharge” found no equilibrium beyond 28 % of its way: step 57 of 200 stagnates \
         after 5 cuts near (31.5, 10.5) m. What was computed until then is kept.",
        "The picture figures/gone is missing.",
    ] {
        assert!(words.contains(expected), "{expected} is missing in {words}");
    }
}

#[test]
fn an_interrupted_run_can_be_resumed() {
    let folder = example::folder("interrupted");
    let mut summary = findings::summary();
    summary.interrupted = true;
    summary.stages.truncate(1);
    (summary.stages[0].outcome, summary.stages[0].reached) = (StageOutcome::Interrupted, 0.4);
    example::write(&folder, &summary);
    let words = words(&page(&folder));
    assert!(words.contains("Interrupted"));
    assert!(words.contains(
        "interrupted in stage “initial stresses” at 40 % of its way; it can be resumed."
    ));
}

#[test]
fn a_bare_summary_is_enough() {
    let folder = example::folder("bare");
    let json = serde_json::to_string(&Summary::default()).unwrap();
    std::fs::write(folder.join("summary.json"), json).unwrap();
    let page = page(&folder);
    assert_stands_alone(&page);
    assert!(words(&page).contains("No stage was run."));
}

#[test]
fn a_folder_without_summary_is_refused_by_name() {
    let folder = example::folder("none");
    let error = write_report(&folder, &Surroundings::default()).unwrap_err();
    assert!(
        matches!(&error, ReportError::Results(ResultsError::File { path, .. }) if path.ends_with("summary.json"))
    );
    std::fs::write(folder.join("summary.json"), "{").unwrap();
    assert!(matches!(
        write_report(&folder, &Surroundings::default()),
        Err(ReportError::Results(ResultsError::File { .. }))
    ));
}

/// GOAL: tables without rows or columns make pictures, not panics.
#[test]
fn empty_tables_make_empty_pictures() {
    let folder = example::folder("empty");
    let case = example::case();
    let empty = |headers: &[&str]| Table::new("empty", headers);
    let mut curve = example::curve();
    for values in [
        ReferenceValues::Level { y: 5.0, at: None },
        ReferenceValues::Level {
            y: 5.0,
            at: Some(0.1),
        },
        ReferenceValues::Points(Vec::new()),
        ReferenceValues::Points(vec![[0.0, 1.0], [1.0, 2.0]]),
    ] {
        curve.reference.as_mut().unwrap().values = values;
        for table in [
            empty(&[]),
            empty(&["a"]),
            empty(&["a", "b"]),
            findings::curve_table(),
        ] {
            pictures::curve_picture(&folder, "empty", &curve, &table).unwrap();
        }
    }
    let (monitor, section) = (&case.monitors[0], &case.sections[0]);
    assert!(
        pictures::monitor_pictures(&folder, &case, monitor, &empty(&[]))
            .unwrap()
            .is_empty()
    );
    let mut table = findings::monitor_table(monitor);
    table.rows.clear();
    assert_eq!(
        pictures::monitor_pictures(&folder, &case, monitor, &table)
            .unwrap()
            .len(),
        2
    );
    let mut table = findings::section_table(section);
    table.rows.clear();
    assert_eq!(
        pictures::section_pictures(&folder, ("", Axes::Plane), section, "s", &[], &table)
            .unwrap()
            .len(),
        2
    );
    pictures::safety_picture(&folder, "", "", &SafetySummary::default()).unwrap();
    let nothing = igimp_model::Case {
        bodies: Vec::new(),
        materials: Vec::new(),
        ..case
    };
    pictures::model_picture(&folder, &nothing).unwrap();
    std::fs::write(folder.join("convergence.csv"), "").unwrap();
    assert!(
        pictures::convergence_pictures(&folder, "", None)
            .unwrap()
            .is_empty()
    );
    std::fs::write(folder.join("convergence.csv"), findings::CONVERGENCE_HEADER).unwrap();
    assert!(
        pictures::convergence_pictures(&folder, "", None)
            .unwrap()
            .is_empty()
    );
}

/// GOAL: attempts at a step are kept apart, and names are safe for files.
#[test]
fn convergence_is_read_by_attempt() {
    let folder = example::folder("convergence");
    let path = folder.join("convergence.csv");
    std::fs::write(&path, findings::convergence()).unwrap();
    let histories = pictures::histories(&path).unwrap();
    let accepted = histories.iter().filter(|history| history.accepted).count();
    assert_eq!((accepted, histories.len()), (80, 84));
    assert!(
        histories
            .iter()
            .all(|h| h.residuals.len() == if h.accepted { 6 } else { 12 })
    );
    let notes = pictures::convergence_pictures(&folder, "t", Some(1e-9)).unwrap();
    let files: Vec<_> = notes.iter().map(|note| note.file.as_str()).collect();
    assert_eq!(
        files,
        [
            "figures/convergence-1-initial-stresses",
            "figures/convergence-2-factor-of-safety"
        ]
    );
    let names = ["A-A  (west)", "../x", "Böschung", "§", "plastic_strain"].map(pictures::file_name);
    assert_eq!(names, ["a-a-west", "x", "b-schung", "x", "plastic_strain"]);
}

/// GOAL: the picture of a field exists for every field.
#[test]
fn every_field_has_a_picture() {
    let folder = example::folder("fields");
    let mut case = example::case();
    case.bodies.truncate(1);
    case.bodies[0].per_direction = 1;
    let (particles, laws) = example::particles(&case);
    let pieces = Pieces::of(&case).unwrap();
    let canvas = Canvas {
        folder: &folder,
        case: &case,
        pieces: &pieces,
    };
    let state = Seen {
        particles: &particles,
        laws: &laws,
    };
    for &field in igimp_model::Field::ALL {
        let shown = Shown::end_of_stage(&case, 0);
        let note = pictures::field_picture(
            &canvas,
            &shown,
            field,
            state,
            &[],
            &pictures::Over::default(),
        )
        .unwrap();
        assert!(
            folder.join(format!("{}.svg", note.file)).exists(),
            "{field:?}"
        );
    }
    let shown = Shown::end_of_stage(&case, 9);
    let beyond = pictures::field_picture(
        &canvas,
        &shown,
        Field::P,
        state,
        &[],
        &pictures::Over::default(),
    )
    .unwrap();
    assert_eq!(beyond.file, "figures/field-10-x-p");
}

/// GOAL: pictures that stand side by side have one unit and one colour bar.
#[test]
fn compared_states_share_unit_and_colours() {
    let folder = example::folder("compared");
    let mut case = example::case();
    case.bodies.truncate(1);
    case.bodies[0].per_direction = 1;
    let (large, laws) = example::particles(&case);
    let mut fields = (*large).clone();
    for displacement in &mut fields.displacement {
        *displacement = displacement.map(|d| 0.01 * d);
    }
    let small = Particles::from_fields(fields).unwrap();
    let pieces = Pieces::of(&case).unwrap();
    let canvas = Canvas {
        folder: &folder,
        case: &case,
        pieces: &pieces,
    };
    let bar = |name: &str, particles: &Particles<2>, compared: &[&Particles<2>]| {
        let shown = Shown {
            name: name.into(),
            title: String::new(),
            when: String::new(),
        };
        let seen = |particles| Seen {
            particles,
            laws: &laws,
        };
        let compared: Vec<_> = compared.iter().map(|&other| seen(other)).collect();
        let drawn = seen(particles);
        let note = pictures::field_picture(
            &canvas,
            &shown,
            Field::Displacement,
            drawn,
            &compared,
            &pictures::Over::default(),
        );
        let path = folder.join(format!("{}.svg", note.unwrap().file));
        let svg = std::fs::read_to_string(path).unwrap();
        // Numbers and label of the colour bar stand to the right of the plot.
        let words = svg
            .split("<text ")
            .filter(|text| text.contains("|u|") || text.contains("x=\"59"));
        words.map(str::to_owned).collect::<Vec<_>>()
    };
    let alone = bar("alone", &small, &[]);
    let first = bar("first", &small, &[&large]);
    let second = bar("second", &large, &[&small]);
    assert!(alone.iter().any(|text| text.contains("[mm]")), "{alone:?}");
    assert!(first.iter().any(|text| text.contains("[m]")), "{first:?}");
    assert_eq!(first, second);
}
