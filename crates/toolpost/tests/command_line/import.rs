//! `machines import`: a post of another system becomes a file, and what it could not carry over is reported.

use crate::folder::Folder;

const POST: &str = r#"POST_NAME = "Shop Grbl (mm) (*.nc)"
VAR X_POSITION = [X|C|X|1.3]
VAR Y_POSITION = [Y|C|Y|1.3]
VAR Z_POSITION = [Z|C|Z|1.3]
VAR FEED_RATE = [F|C|F|1.1]
begin HEADER
"( [DATE] )"
begin RAPID_MOVE
"G0[X][Y][Z]"
begin FEED_MOVE
"G1[X][Y][Z][F]"
"#;

#[test]
fn a_post_becomes_a_file_that_posts() {
    let folder = Folder::new();
    folder.write("shop.pp", POST);
    let said = folder.run(&["machines", "import", "shop.pp", "-o", "mine.toml"]);
    assert_eq!(said.code, 0, "{said:?}");
    assert!(said.err.contains("shop.pp:7: warning[not-carried-over]"), "{said:?}");
    assert!(said.out.contains("extends  grbl") && said.out.contains("proven"), "{said:?}");
    assert_eq!(folder.run(&["machines", "check", "mine.toml"]).code, 0);
    let said = folder.run(&["machines", "import", "shop.pp", "-o", "mine.toml", "--json"]).json();
    assert_eq!((&said["sample"], &said["extends"]), (&"proven".into(), &"grbl".into()));
    assert_eq!(said["warnings"][1]["line"], 7);
    // No post says where Z is at its top: that of any mill with this control, and it is reported.
    assert!(said["warnings"][0]["message"].as_str().unwrap().contains("`safe_height = -1`"));
}

#[test]
fn a_file_whose_sample_is_not_proven_is_saved_and_reported() {
    let folder = Folder::new();
    // No control knows what 1 is without its G.
    folder.write("shop.pp", POST.replace("G1[X]", "1[X]"));
    let said = folder.run(&["machines", "import", "shop.pp", "-o", "mine.toml"]);
    assert_eq!(said.code, 1, "{said:?}");
    assert!(said.err.contains("error[") && said.out.contains("not proven"), "{said:?}");
    assert!(folder.names().contains(&"mine.toml".to_string()));
}

#[test]
fn nothing_is_saved_of_what_cannot_be_read() {
    let folder = Folder::new();
    folder.write("shop.pp", POST.replace("begin HEADER\n", ""));
    let said = folder.run(&["machines", "import", "shop.pp", "-o", "mine.toml"]);
    assert_eq!(said.code, 2, "{said:?}");
    assert!(said.err.contains("shop.pp:6: error[import]"), "{said:?}");
    let said = folder.run(&["machines", "import", "shop.pp", "-o", "shop.pp"]);
    assert!(said.code == 2 && said.err.contains("is the input shop.pp"), "{said:?}");
    folder.write("plain.pp", POST.replace("Grbl", "router"));
    let said = folder.run(&["machines", "import", "plain.pp", "-o", "mine.toml"]);
    assert!(said.code == 2 && said.err.contains("--extends"), "{said:?}");
    assert!(!folder.names().contains(&"mine.toml".to_string()));
}

#[test]
fn what_it_extends_is_found_from_where_it_is_saved() {
    let folder = Folder::new();
    folder.write("shop.pp", POST);
    for made in ["lib", "out"] {
        std::fs::create_dir(folder.path().join(made)).unwrap();
    }
    folder.write("lib/my.toml", "extends = \"grbl\"\ntitle = \"Mine\"\n");
    for (output, extends) in [("out/a.toml", "../lib/my.toml"), ("b.toml", "lib/my.toml")] {
        let words =
            ["machines", "import", "shop.pp", "--extends", "lib/my.toml", "-o", output, "--json"];
        let said = folder.run(&words).json();
        assert_eq!((&said["sample"], &said["extends"]), (&"proven".into(), &extends.into()));
        assert_eq!(folder.run(&["machines", "check", output]).code, 0);
    }
}

#[test]
fn a_file_that_is_no_machine_is_not_named() {
    let folder = Folder::new();
    folder.write("shop.pp", POST);
    folder.write("0.toml", "extends = \"generic-3axis-grbl\"\n");
    for above in 1..20 {
        folder.write(&format!("{above}.toml"), format!("extends = \"{}.toml\"\n", above - 1));
    }
    // The last that still loads: what extends it is one too many.
    let loads = |name: &String| folder.run(&["machines", "check", name]).code == 0;
    let last = (0..20).map(|above| format!("{above}.toml")).take_while(loads).last().unwrap();
    let said =
        folder.run(&["machines", "import", "shop.pp", "--extends", &last, "-o", "mine.toml"]);
    assert_eq!(said.code, 2, "{said:?}");
    assert!(said.err.contains("shop.pp:7: warning[not-carried-over]"), "{said:?}");
    assert!(said.err.contains("shop.pp: error[machine-file]: what it becomes"), "{said:?}");
    assert!(!said.err.contains("mine.toml"), "{said:?}");
    assert!(!folder.names().contains(&"mine.toml".to_string()));
}
