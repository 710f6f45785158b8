//! Templates that are refused before anything is written, and those that are not.

use std::time::{Duration, Instant};

/// What `post::check` says of a machine with this `program_start`.
fn checked(template: &str) -> Result<(), String> {
    let text = format!(
        "extends = \"generic-3axis-linuxcnc\"\n[options]\nfirst_offset = 100\nshop = \"north\"\n[blocks]\n\
         program_start = '''{template}'''\n"
    );
    let machine = machine::load_text("mine.toml", &text).unwrap();
    toolpost_post::check(&machine).map_err(|found| found[0].to_string())
}

/// What `post::check` says of a machine with this HEIGHT.
fn kept(word: &str) -> Result<(), String> {
    let text = format!("extends = \"generic-3axis-linuxcnc\"\n[words]\nHEIGHT = {{ {word} }}\n");
    let machine = machine::load_text("mine.toml", &text).unwrap();
    toolpost_post::check(&machine).map_err(|found| found[0].to_string())
}

/// A subroutine has #1 to #30 for itself.
#[test]
fn heights_are_kept_in_whole_parameters_of_the_program() {
    for right in ["first = 31", "first = 5000", "max = 1001"] {
        kept(right).expect(right);
    }
    for wrong in ["first = 30", "first = 5001", "max = 1000", "decimals = 1", "scale = 2"] {
        let said = kept(wrong).expect_err(wrong);
        assert!(said.contains("error[machine-word]") && said.starts_with("mine.toml:3:"), "{said}");
    }
}

/// Each would take more memory than a machine has, or more time than a person.
#[test]
fn a_value_that_grows_without_bound_is_refused_at_once() {
    let doubled =
        "{% set a = program.name %}".to_owned() + &"{% set a = a ~ a %}".repeat(50) + "{{ a }}";
    let nested =
        "{{ ".to_owned() + &"(".repeat(100) + "program.name" + &" ~ 'x' * 99)".repeat(100) + "}}";
    let deep = "{{ 1".to_owned() + &"+1".repeat(1_000_000) + "}}";
    let replaced = "{{ 'xxxxxxxx'".to_owned() + &"|replace('x','xxxxxxxx')".repeat(12) + "}}";
    let chained = "{{ program.name".to_owned() + &" ~ program.name".repeat(500) + "}}";
    for (template, rule) in [
        (
            "{% set x = range(99999) %}{{ x|list|join('xxxxxxxxxx')|upper|replace('X','XXXXXXXXXX') }}",
            "template-name",
        ),
        ("{{ 'x' * 2000000000 }}", "template-output"),
        ("{{ program.name * 99999999 }}", "template-output"),
        ("{{ [1] * 99999999 }}", "template"),
        ("{{ options.shop + options.shop }}", "template-output"),
        (&doubled, "template-output"),
        (&nested, "template"),
        (&deep, "template-output"),
        (&deep[..8000], "template"),
        (&(deep[..8000].to_owned() + "}}"), "template-output"),
        (&replaced, "template"),
        (&chained, "template-output"),
        ("{% for t in program.tools %}{% set a = a ~ a %}{% endfor %}", "template-output"),
        ("{% for a in ['x' ~ 'x'] %}{{ a }}{% endfor %}", "template"),
        ("{% for i in range(1000) recursive %}{{ loop(i) }}{% endfor %}", "template"),
        ("{{ 5 in range(100000) }}", "template-name"),
        ("{{ '%1000000000d'|format(1) }}", "template"),
        ("{% if 5 is divisibleby(0) %}{% endif %}", "template"),
        (
            "{% for i in range(9223372036854775807, -9223372036854775807, -1) %}{% endfor %}",
            "template",
        ),
        ("{{ '%*d'|format(1000000000, 1) }}", "template"),
        ("{% set a %}{{ program.name }}{% endset %}", "template"),
        ("{% with a = 1 %}{% endwith %}", "template"),
        ("{% filter upper %}x{% endfilter %}", "template"),
        ("{% macro a() %}x{% endmacro %}", "template"),
        ("{% set n = namespace() %}", "template-name"),
        ("{{ program }}", "template"),
        ("{{ program.tools|default(1) }}", "template"),
        ("{{ (program or 1) ~ 1 }}", "template"),
    ] {
        let started = Instant::now();
        let said = checked(template).expect_err(template);
        assert!(said.starts_with("mine.toml:6:"), "{said}");
        assert!(said.contains(&format!("error[{rule}]")), "{rule}: {said}");
        assert!(started.elapsed() < Duration::from_secs(2), "{template}");
    }
}

#[test]
fn what_a_machinist_needs_of_jinja_is_there() {
    for template in [
        "O{{ '%04d'|format(options.first_offset + 5) }}",
        "{% set base = options.first_offset %}{% for t in program.tools %}{% if t.number > 2 %}\
         (T{{ t.number + base * 10 }} {{ t.name[0:8]|upper }}){% endif %}{% endfor %}",
        "({{ tool.name|replace(' ', '_')|default('NONE') }} {{ tool.diameter|round(2) }})",
        "({{ (tool.diameter|default(10)) / 2 }} {{ -tool.length // 3 }})",
        "{% if tool.number in [1, 2, 3] and options.shop == 'north' %}M50{% else %}M51{% endif %}",
        "({{ program.tools|length }} {{ (program.tools|first).number }} {{ program.tools[0].name }})",
        "{% if tool is defined and tool.corner_radius is number %}M52{% endif %}",
        "({{ machine.title }} {{ 'a' if tool.first else 'b' }} {{ options.shop ~ '-' ~ tool.number }})",
        "{% for i in range(3) %}M5{{ loop.index * i }}\n{% endfor %}",
        "{% if tool.number is divisibleby(2) %}M50{% endif %}",
    ] {
        assert_eq!(checked(template), Ok(()), "{template}");
    }
}

#[test]
fn a_name_that_the_engine_does_not_know_is_refused_with_those_that_it_knows() {
    let said = checked("{{ program.name|uper }}").unwrap_err();
    assert!(said.contains("there is no filter `uper`") && said.contains("`upper`"), "{said}");
    let said = checked("{% if tool is definde %}{% endif %}").unwrap_err();
    assert!(said.contains("there is no test `definde`") && said.contains("`defined`"), "{said}");
    let said = checked("{% include '/etc/passwd' %}").unwrap_err();
    assert!(said.contains("include") && said.contains("`if`, `for` and `set`"), "{said}");
    let said = checked("{% set X = 1 %}").unwrap_err();
    assert!(said.contains("`X` has a meaning already"), "{said}");
}

/// A machine file whose orientation is written in a way that no block of its control writes.
#[test]
fn a_way_to_write_the_tool_axis_that_no_block_writes_is_refused() {
    let found = |control: &str, modes: [&str; 2], blocks: &str| {
        let axis = |letter, axis| {
            format!(
                "[[rotary]]\nletter = \"{letter}\"\non = \"table\"\naxis = {axis}\npoint = [0, 0, 0]\nmodulo = false\nmin = -100\n\
                 max = 100\nrapid = 9000\nacceleration = 400\n"
            )
        };
        let text = format!(
            "extends = \"{control}\"\nsafe_height = 0\nwork_zero = [0, 0, 0]\n[orientation]\nsimultaneous = \"{}\"\npositioned = \"{}\"\ntolerance = 0.01\n\
             [blocks]\n{blocks}\n{}{}",
            modes[0],
            modes[1],
            axis("B", "[0, 1, 0]"),
            axis("C", "[0, 0, 1]")
        );
        let machine = machine::load_text("mine.toml", &text).unwrap();
        match toolpost_post::check(&machine) {
            Ok(()) => String::new(),
            Err(found) => found.iter().map(|error| format!("{error}\n")).collect(),
        }
    };
    let refused = |control, modes, blocks, words: &[&str]| {
        let said = found(control, modes, blocks);
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    };
    let (angles, tip, vectors, plane) =
        ("machine-angles", "tool-center-angles", "vectors", "tilted-plane");
    for (control, modes) in [
        ("heidenhain-tnc640", [tip, plane]),
        ("sinumerik-840d", [vectors, plane]),
        ("sinumerik-840d", [angles, angles]),
        ("fanuc-31i", [tip, plane]),
    ] {
        assert_eq!(found(control, modes, ""), "", "{control} {modes:?}");
    }
    refused(
        "heidenhain-tnc640",
        [vectors, plane],
        "",
        &[
            "error[missing-word]: the block `linear` lacks `VX`: `orientation.simultaneous` is \"vectors\"",
            "tool-center-angles",
        ],
    );
    // LinuxCNC follows no tip by itself, nor has it a tilted plane.
    refused(
        "linuxcnc",
        [tip, tip],
        "",
        &["the block `tool_center_on` is missing: `orientation.simultaneous`"],
    );
    refused(
        "linuxcnc",
        [angles, plane],
        "",
        &["the block `plane_tilt` is missing: `orientation.positioned`"],
    );
    refused(
        "sinumerik-840d",
        [tip, tip],
        "tool_center_on = \"\"",
        &["`tool_center_on` is missing"],
    );
    let tilt = "plane_tilt = \"{{N}} CYCLE800({{OX}})\"";
    refused("sinumerik-840d", [angles, plane], tilt, &["mine.toml:9", "says no angle"]);
    let linear =
        "linear = \"{{N}} G1 {{X}} {{Y}} {{Z}} {{compensation}} {{feed_mode}} {{C}} {{F}}\"";
    refused(
        "sinumerik-840d",
        [angles, angles],
        linear,
        &["mine.toml:9", "the block `linear` lacks `B`"],
    );
}

/// A control that keeps one F for cuts and rapids: how fast a rapid goes is not made up.
#[test]
fn a_rapid_that_goes_at_an_f_needs_the_speed_of_an_axis() {
    let found = |axes: &str| {
        let text = format!("extends = \"marlin\"\nsafe_height = 100\n{axes}");
        let machine = machine::load_text("mine.toml", &text).unwrap();
        toolpost_post::check(&machine).map_err(|found| found[0].to_string())
    };
    let said = found("").unwrap_err();
    assert!(said.contains("error[rapid-feed]") && said.contains("[axes]"), "{said}");
    assert_eq!(found("[axes]\nX = { rapid = 6000 }\n"), Ok(()));
}

#[test]
fn a_promise_that_a_file_does_not_keep_is_reported_where_the_file_makes_it() {
    let found = |text: &str| {
        let text = format!("extends = \"generic-3axis-linuxcnc\"\n{text}");
        let machine = machine::load_text("mine.toml", &text).unwrap();
        let found = toolpost_post::check(&machine).expect_err(&text);
        found.iter().map(|error| format!("{error}\n")).collect::<String>()
    };
    let said = found("[blocks]\nlinear = \"{{N}} G1 {{X}} {{Y}}\"\n");
    assert!(
        said.contains("mine.toml:3: error[missing-word]: the block `linear` lacks `Z`"),
        "{said}"
    );
    assert!(said.contains("lacks `F`"), "{said}");
    let said = found("[words]\nQQ = { decimals = 3 }\n");
    assert!(said.contains("mine.toml:3: error[machine-word]: no word is called `QQ`"), "{said}");
    let said = found("[words.motion]\ncodes = { rapid = \"G0\" }\n");
    assert!(
        said.contains("mine.toml:2: error[machine-word]: [words.motion] has no text for `linear`"),
        "{said}"
    );
}
