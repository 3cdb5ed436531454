//! The report stands alone: well-formed, without scripts or requests, and it says what the diagnosis says.

use hysteron_core::criticism::DiagnosisJob;
use hysteron_core::diagnosis::{
    Diagnosis, Discovery, DiscoveryEnd, FoundFormula, Parameter, Status, StepReport,
};
use hysteron_core::measurement::{Measurement, import_csv};
use hysteron_core::message::Message;
use hysteron_core::progress::Progress;
use hysteron_core::report::{Provenance, ReportInput, Tongue, baseline, html, sha256};

fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(format!(
        "{}/../tests/data/{name}.csv",
        env!("CARGO_MANIFEST_DIR")
    ))
    .unwrap()
}

fn diagnose(measurement: &Measurement) -> (Diagnosis, StepReport, StepReport) {
    let mut job = DiagnosisJob::new(measurement).unwrap();
    loop {
        if let Progress::Done(diagnosis) = job.advance() {
            let (first, last) = job.evidence().unwrap();
            return (diagnosis, first.clone(), last.clone());
        }
    }
}

fn page(measurement: &Measurement, command: &str) -> (Diagnosis, String) {
    page_with(measurement, command, None)
}

fn page_with(
    measurement: &Measurement,
    command: &str,
    discovery: Option<&Discovery>,
) -> (Diagnosis, String) {
    let (diagnosis, first, last) = diagnose(measurement);
    assert_eq!(
        last.step.effects,
        diagnosis.steps.last().unwrap().effects,
        "the curves are those of the last model"
    );
    let text = html(&ReportInput {
        measurement,
        steps: &diagnosis.steps,
        first_atlas: &first.atlas,
        last: &last,
        verdict: Some(&diagnosis.verdict),
        discovery,
        model: None,
        provenance: &Provenance {
            command: command.to_owned(),
            version: "1.2.3".to_owned(),
            bytes: 4711,
            sha256: sha256(b"abc"),
        },
        tongue: Tongue::ENGLISH,
    });
    (diagnosis, text)
}

/// The page apart from its style sheet, as tags with the text that follows each.
fn tags(page: &str) -> Vec<(&str, &str)> {
    let (before, rest) = page.split_once("<style>").unwrap();
    let (_, after) = rest.split_once("</style>").unwrap();
    let split = |part| str::split(part, '<').skip(1);
    split(before)
        .chain(split(after))
        .map(|piece| piece.split_once('>').expect("a tag ends"))
        .collect()
}

/// Every tag that opens closes, in order.
fn check_well_formed(page: &str) {
    let mut open: Vec<String> = Vec::new();
    for (tag, text) in tags(page) {
        assert!(!text.contains('>'), "stray > in: {text}");
        if tag.starts_with('!') || tag.ends_with('/') {
            continue;
        }
        let name = tag.split_whitespace().next().unwrap().to_owned();
        if let Some(closed) = name.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(closed), "in {tag}");
        } else if name != "meta" {
            open.push(name);
        }
    }
    assert_eq!(open, Vec::<String>::new());
}

/// No script, no other file, no handler of events: only elements and attributes that draw.
fn check_self_contained(page: &str) {
    let elements = "html head meta title style body main header section h1 h2 h3 p ul li div span figure figcaption \
                    table thead tbody tr th td code pre strong svg path rect text \
                    math mrow mi mn mo mtext msub msup mfrac mspace";
    let attributes = "lang charset name content class viewBox width height aria-hidden role x y rx d text-anchor transform aria-label";
    for (tag, _) in tags(page) {
        let tag = tag.trim_start_matches('/').trim_end_matches('/');
        if tag == "!doctype html" {
            continue;
        }
        let (name, rest) = tag.split_once(' ').unwrap_or((tag, ""));
        assert!(elements.split_whitespace().any(|e| e == name), "<{tag}>");
        // Every second piece between quotes is a value.
        for attribute in rest.split('"').step_by(2).filter(|a| !a.is_empty()) {
            let attribute = attribute.trim().trim_end_matches('=');
            assert!(
                attributes.split_whitespace().any(|a| a == attribute),
                "{attribute} in <{tag}>"
            );
        }
    }
    let style = page.split_once("<style>").unwrap().1;
    let style = style.split_once("</style>").unwrap().0;
    for forbidden in ["url(", "@import", "://"] {
        assert!(!style.contains(forbidden), "{forbidden}");
    }
}

#[test]
fn a_report_says_what_the_diagnosis_says() {
    let measurement = import_csv("process-02", &bytes("process-02"), None).unwrap();
    let (diagnosis, page) = page(&measurement, "hysteron diagnose process-02.csv");
    check_well_formed(&page);
    check_self_contained(&page);
    let last = diagnosis.steps.last().unwrap();
    for text in [
        diagnosis.verdict.text.to_string(),
        "u_acting(t) = u(t - tau)".to_owned(),
        baseline(measurement.kind, &last.parameters)[0].to_owned(),
        "hysteron diagnose process-02.csv".to_owned(),
        "4711 bytes".to_owned(),
        sha256(b"abc"),
        "Hysteron 1.2.3".to_owned(),
        "prefers-color-scheme: dark".to_owned(),
        "@media print".to_owned(),
        last.findings
            .first()
            .map_or_else(String::new, |f| f.text.to_string()),
        diagnosis.steps[0].findings[0].text.to_string(),
    ] {
        assert!(page.contains(&text), "'{text}' is missing");
    }
    // The equation is of this model: it has every parameter of the baseline.
    let own = last.parameters.iter().filter(|p| p.effect.is_none());
    let equation = baseline(measurement.kind, &last.parameters)[0];
    for name in own.map(|p| p.name.as_str()) {
        assert!(equation.contains(name), "{name} is not in {equation}");
    }
    // Detail, its residual, the whole residual; one picture an axis at least; the waterfall.
    assert!(page.matches("<figure>").count() >= 5);
    for parameter in &last.parameters {
        let cell = format!("<td><math aria-label=\"{}\">", parameter.name);
        assert!(page.contains(&cell), "{cell} is missing");
    }
}

#[test]
fn text_from_a_file_never_becomes_markup() {
    let text = String::from_utf8(bytes("process-02")).unwrap();
    let hostile = "\"><script>alert(1)</script><img src=x onerror=alert(1)>&amp;";
    let mut measurement = import_csv(hostile, text.as_bytes(), None).unwrap();
    measurement.warnings.push(Message::name(hostile));
    measurement.outputs[0].name = hostile.to_owned();
    measurement.outputs[0].unit = hostile.to_owned();
    measurement.input.unit = hostile.to_owned();
    let (_, page) = page(&measurement, hostile);
    check_well_formed(&page);
    check_self_contained(&page);
}

#[test]
fn a_formula_that_was_looked_for_has_its_section() {
    let formula = |length, error, in_class| FoundFormula {
        name: format!("formula_{length}"),
        formula: format!("-a*y^{length}"),
        length,
        error,
        on_front: true,
        in_class,
        parameters: vec![Parameter {
            effect: None,
            name: "a".to_owned(),
            label: "a".to_owned(),
            value: 2.0,
            std_error: 0.1,
            unit: "1".to_owned(),
            status: Status::Free,
        }],
        body: Vec::new(),
        typed: format!("formula_{length}: -a*y^{length}; a = 2"),
    };
    let discovery = Discovery {
        end: DiscoveryEnd::Explained,
        before: 25.0,
        answer: Some(1),
        formulas: vec![formula(3, 7.0, false), formula(5, 1.01, true)],
        curve: None,
        experiment: None,
        text: "Input = -a*y^5 & no <b>more</b>.".into(),
    };
    let measurement = import_csv("process-02.csv", &bytes("process-02"), None).unwrap();
    let (_, without) = page(&measurement, "hysteron");
    assert!(!without.contains("The formula of the unknown"));
    let (_, page) = page_with(&measurement, "hysteron", Some(&discovery));
    check_well_formed(&page);
    check_self_contained(&page);
    for text in [
        "<h2>The formula of the unknown</h2>",
        "<p>Input = <math aria-label=\"-a*y^5\">",
        " &amp; no &lt;b&gt;more&lt;/b&gt;.</p>",
        "<math aria-label=\"-a*y^3\">",
        "<msup><mi>y</mi><mrow><mn>5</mn></mrow></msup>",
        "a = 2.0 ± 5 % (95 %: 1.80 to 2.20)",
        "length of the formula",
        "--effect &#39;formula_5: -a*y^5; a = 2&#39;",
    ] {
        assert!(page.contains(text), "'{text}' is missing");
    }
    assert_eq!(page.matches("class=\"diamond\"").count(), 1);
    assert_eq!(page.matches("a3 3 0 1 0 6 0").count(), 2);
}
