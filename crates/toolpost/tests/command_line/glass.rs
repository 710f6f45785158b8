//! `toolpost glass`.

use crate::folder::Folder;

#[test]
fn the_tables_of_the_glass_engraver_agree_and_name_the_slips() {
    let folder = Folder::empty();
    let said = folder.run(&["glass", "tables"]);
    assert_eq!(said.code, 0, "{said:?}");
    assert!(said.out.contains("(24, 30)") && said.out.contains("<- not its point"), "{said:?}");
    assert!(said.out.contains("Slips of the source"), "{said:?}");
    assert!(!said.out.contains("<- differs"), "{said:?}");
}
