//! The seeds of the fuzz target are programs that run to their end.

#[test]
fn every_seed_of_the_fuzz_target_runs() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/seeds/sinumerik");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let records =
            crate::common::sinumerik::run(&text).unwrap_or_else(|e| panic!("{path:?}: {e}"));
        assert_eq!(records.last().unwrap().action, toolpost_control::Action::End);
        count += 1;
    }
    assert!(count >= 4);
}
