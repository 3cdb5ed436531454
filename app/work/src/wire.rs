//! What the page and its worker tell each other, as bytes (CBOR): every number arrives as it was sent, NaN too, and
//! a file in one piece.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// A message as bytes.
///
/// # Errors
/// One sentence.
pub fn pack<T: Serialize>(message: &T) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    ciborium::into_writer(message, &mut bytes).map_err(|e| e.to_string())?;
    Ok(bytes)
}

/// A message from its bytes.
///
/// # Errors
/// One sentence.
pub fn unpack<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, String> {
    ciborium::from_reader(bytes).map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::content::Content;
    use crate::enclosed;
    use crate::reading::Reading;
    use crate::tasks::{News, ReadReport, ReadTask, StepTask, Unclear};
    use crate::work::Work;

    /// What a task says at its end, sent there and back.
    fn sent<T: Work>(task: &T) -> T::Report {
        let task: T = unpack(&pack(task).expect("bytes")).expect("the task");
        let mut report = None;
        task.run(&mut |news| {
            let news: News<T::Report> = unpack(&pack(&news).expect("bytes")).expect("the news");
            match news {
                News::Report(said) => report = Some(*said),
                News::Failed(error) => panic!("{error}"),
                News::Progress(..) => {}
            }
            true
        });
        report.expect("a report")
    }

    #[test]
    fn a_file_and_its_diagnosis_arrive_as_they_were_sent() {
        let task = ReadTask {
            file: "process-02.csv".to_owned(),
            content: enclosed::PROCESS_02.content(),
            reading: Reading::default(),
        };
        let ReadReport::Measurement(opened) = sent(&task) else {
            panic!("a measurement");
        };
        assert_eq!(opened.source.bytes, enclosed::PROCESS_02.csv().len());
        let task = || StepTask {
            measurement: Box::new(opened.measurement.clone()),
            effects: Vec::new(),
            model: None,
        };
        let mut here = None;
        task().run(&mut |news| {
            if let News::Report(report) = news {
                here = Some(*report);
            }
            true
        });
        let [here, there] = [here.expect("a report"), sent(&task())];
        assert!(here.step.candidates.len() > 1);
        // Each number prints as the shortest text that gives it back.
        assert_eq!(format!("{here:?}"), format!("{there:?}"));
    }

    #[test]
    fn a_table_that_says_nothing_comes_back_with_its_columns() {
        let csv = (0..40).fold("a,b,c\n".to_owned(), |csv, i| {
            csv + &format!("{i},{},nan\n", i % 7)
        });
        let task = ReadTask {
            file: "x.csv".to_owned(),
            content: Content::Plain(csv.into_bytes().into()),
            reading: Reading::default(),
        };
        let ReadReport::Unclear(Unclear { columns, .. }) = sent(&task) else {
            panic!("it does not say what its columns are");
        };
        assert_eq!(columns.len(), 3);
        assert!(columns[2].numbers.first[0].is_nan());
    }

    #[test]
    fn what_is_no_message_is_refused() {
        assert!(unpack::<ReadTask>(b"\x93").is_err());
        assert!(unpack::<News<ReadReport>>(b"").is_err());
    }
}
