//! Passes, leads, tabs, taper and order, by hand.

use geom::Vec2;
use std::f64::consts::{PI, TAU};
use toolpost_wire::offset::Corners;
use toolpost_wire::plan::{Cut, Opening, Pass, Plan, Settings, Side, Taper, Trims, plan};
use toolpost_wire::taper::Rounding;
use toolpost_wire::{Contour, Element, Lead, LeadShape};

fn p(x: f64, y: f64) -> Vec2 {
    Vec2::new(x, y)
}

fn polygon(corners: &[Vec2]) -> Contour {
    let next = corners.iter().cycle().skip(1);
    let elements = corners.iter().zip(next).zip(1..);
    let elements = elements.map(|((&p, &q), line)| Element::line(p, q).from_line(line)).collect();
    Contour::new(elements, 0.0).unwrap()
}

/// 30 × 20 mm from the origin, counter-clockwise.
fn plate() -> Contour {
    polygon(&[p(0.0, 0.0), p(30.0, 0.0), p(30.0, 20.0), p(0.0, 20.0)])
}

fn circle(center: Vec2, radius: f64) -> Contour {
    let start = center + Vec2::X * radius;
    Contour::new(vec![Element::arc(start, start, center, TAU).from_line(9)], 0.0).unwrap()
}

fn opening(contour: Contour, side: Side) -> Opening {
    Opening { contour, side, thread: None, start: None }
}

fn settings(offsets: &[f64]) -> Settings {
    Settings {
        passes: offsets.iter().map(|&offset| Cut { offset, feed: 6.0 }).collect(),
        trims: Trims::Alternate,
        lead: Lead { length: 5.0, shape: LeadShape::Straight },
        tab: 0.0,
        corners: Corners::Refuse,
        taper: None,
        by_control: false,
    }
}

fn punch() -> Opening {
    Opening { thread: Some(p(15.0, -5.0)), ..opening(plate(), Side::Outside) }
}

fn planned(opening: Opening, settings: &Settings) -> Plan {
    plan(&[opening], settings).unwrap()
}

fn rule(opening: Opening, settings: &Settings) -> &'static str {
    plan(&[opening], settings).unwrap_err().rule.name()
}

/// Every pass but the first starts where the one before ends, unless the wire is threaded anew.
fn holds_together(passes: &[Pass]) {
    assert!(passes.first().unwrap().thread && passes.last().unwrap().cut);
    for pair in passes.windows(2) {
        assert_eq!(pair[0].cut, pair[1].thread);
        if !pair[1].thread {
            assert_eq!(pair[0].path.lower().end(), pair[1].path.lower().start());
        }
    }
}

/// 100 mm of sides, four quarter circles of 0.15 mm, 4.85 mm there and back, at 6 mm/min.
#[test]
fn a_punch_in_one_pass() {
    let plan = planned(punch(), &settings(&[0.15]));
    let [pass] = plan.passes.as_slice() else { panic!("{plan:?}") };
    let length = 100.0 + TAU * 0.15 + 2.0 * 4.85;
    assert!((pass.path.length() - length).abs() < 1e-9);
    assert!((plan.cutting_time() - length * 10.0).abs() < 1e-6);
    assert!(pass.thread && pass.cut && !pass.stop && !pass.left);
    assert_eq!(pass.path.lower().start(), p(15.0, -5.0));
    assert_eq!(pass.path.lower().elements()[0].end, p(15.0, -0.15));
    assert_eq!(pass.path.lower().end(), p(15.0, -5.0));
}

#[test]
fn trim_passes_alternate_or_repeat() {
    let alternate = planned(punch(), &settings(&[0.2, 0.17, 0.15]));
    holds_together(&alternate.passes);
    assert_eq!(alternate.passes.iter().map(|p| p.left).collect::<Vec<_>>(), [false, true, false]);
    let areas = |plan: &Plan| -> Vec<f64> {
        plan.passes.iter().map(|pass| pass.path.lower().area()).collect()
    };
    for (area, (offset, side)) in
        areas(&alternate).iter().zip([(0.2, 1.0), (0.17, -1.0), (0.15, 1.0)])
    {
        let expected = side * (600.0 + 100.0 * offset + PI * offset * offset);
        assert!((area - expected).abs() < 1e-9, "{area} {expected}");
    }
    let repeat = Settings { trims: Trims::Repeat, ..settings(&[0.2, 0.15]) };
    let repeat = planned(punch(), &repeat);
    holds_together(&repeat.passes);
    assert!(areas(&repeat).iter().all(|area| *area > 0.0));
}

#[test]
fn the_tab_is_cut_last_and_the_operator_holds_the_part() {
    for count in [1, 2, 3] {
        for trims in [Trims::Alternate, Trims::Repeat] {
            let offsets = &[0.2, 0.17, 0.15][..count];
            let plan = planned(punch(), &Settings { tab: 3.0, trims, ..settings(offsets) });
            holds_together(&plan.passes);
            assert_eq!(plan.passes.len(), 2 * count);
            let (main, tabs) = plan.passes.split_at(count);
            assert!(main.iter().all(|pass| !pass.tab && !pass.stop));
            assert!(tabs.iter().all(|pass| pass.tab));
            assert_eq!(tabs.iter().map(|p| p.stop).filter(|stop| *stop).count(), 1);
            assert!(tabs[0].stop);
            // The first pass stops 3 mm before it has come round: the start is at X15 Y-0.2.
            let end = main[0].path.lower().end();
            assert!(end.distance(p(12.0, -0.2)) < 1e-9, "{end}");
            // The tab is cut once at each offset.
            for (tab, offset) in tabs.iter().zip(offsets) {
                let at = |x: f64| {
                    tab.path.lower().elements().iter().any(|e| {
                        e.start.distance(p(x, -offset)) < 1e-9
                            || e.end.distance(p(x, -offset)) < 1e-9
                    })
                };
                assert!(at(12.0) && at(15.0), "{tab:?}");
            }
        }
    }
}

#[test]
fn an_arc_runs_into_the_contour_without_a_corner() {
    let lead = Lead { length: 5.0, shape: LeadShape::Arc(1.0) };
    let plan = planned(punch(), &Settings { lead, ..settings(&[0.15]) });
    let elements = plan.passes[0].path.lower().elements();
    let arc = elements[1];
    assert!(arc.end.distance(p(15.0, -0.15)) < 1e-12);
    assert!(arc.tangent(1.0).distance(elements[2].tangent(0.0)) < 1e-9);
    assert!(arc.start.distance(p(14.0, -1.15)) < 1e-12, "{:?}", arc.start);
    let out = elements[elements.len() - 2];
    assert!(out.start.distance(p(15.0, -0.15)) < 1e-9 && out.end.distance(p(16.0, -1.15)) < 1e-9);
    assert!(out.tangent(0.0).distance(elements[elements.len() - 3].tangent(1.0)) < 1e-9);
}

#[test]
fn a_lead_in_through_the_part_is_refused() {
    let inside = Opening { thread: Some(p(15.0, 10.0)), ..punch() };
    assert_eq!(rule(inside, &settings(&[0.15])), "cuts-part");
    // An arc of 12 mm does not fit into an opening of 20 mm.
    let hole = opening(circle(p(0.0, 0.0), 10.0), Side::Inside);
    let lead = Lead { length: 5.0, shape: LeadShape::Arc(12.0) };
    assert_eq!(rule(hole.clone(), &Settings { lead, ..settings(&[0.15]) }), "cuts-part");
    let lead = Lead { length: 5.0, shape: LeadShape::Arc(3.0) };
    assert!(plan(&[hole], &Settings { lead, ..settings(&[0.15]) }).is_ok());
    // Through the neighbour.
    let neighbour = opening(circle(p(15.0, -10.0), 4.0), Side::Inside);
    let far = Opening { thread: Some(p(15.0, -20.0)), ..punch() };
    let refused = plan(&[neighbour, far], &settings(&[0.15])).unwrap_err();
    assert_eq!(refused.rule.name(), "cuts-part");
    assert!(refused.message.contains("opening 2"), "{refused}");
}

#[test]
fn inner_openings_come_before_the_outer_one_and_travel_is_short() {
    let hole = |x: f64, y: f64| opening(circle(p(x, y), 2.0), Side::Inside);
    let openings = [punch(), hole(26.0, 10.0), hole(5.0, 10.0), hole(15.0, 10.0)];
    let lead = Lead { length: 1.0, shape: LeadShape::Straight };
    let plan = plan(&openings, &Settings { lead, ..settings(&[0.15]) }).unwrap();
    let order: Vec<usize> = plan.passes.iter().map(|pass| pass.opening).collect();
    assert_eq!(order, [1, 3, 2, 0]);
    // From hole to hole 11 and 10 mm, threaded 1 mm inside at X+; then to the punch.
    let last = p(6.0, 10.0).distance(p(15.0, -5.0));
    assert!((plan.travel() - 21.0 - last).abs() < 1e-9, "{}", plan.travel());
}

/// 10° over 20 mm: the upper contour is 3.527 mm farther out; across a leaning wire its radius is
/// 1/cos 10° longer.
#[test]
fn a_taper_leans_every_pass_and_the_wire_stands_upright_where_it_is_threaded() {
    let taper = Taper { angle: 10f64.to_radians(), height: 20.0, rounding: Rounding::Conical };
    let hole = opening(circle(p(0.0, 0.0), 10.0), Side::Inside);
    let plan = planned(hole, &Settings { taper: Some(taper), ..settings(&[0.15]) });
    let path = &plan.passes[0].path;
    let radius = 10.0 - 0.15 / 10f64.to_radians().cos();
    let pairs: Vec<_> = path.elements().collect();
    assert!((pairs[1].0.radius().unwrap() - radius).abs() < 1e-9);
    let above = radius + 20.0 * 10f64.to_radians().tan();
    assert!((pairs[1].1.radius().unwrap() - above).abs() < 1e-9);
    assert_eq!(pairs[0].0.start, pairs[0].1.start);
    assert!((pairs[0].1.end.x - above).abs() < 1e-9);
    let steep = Taper { angle: 1.2, ..taper };
    assert_eq!(rule(punch(), &Settings { taper: Some(steep), ..settings(&[0.1]) }), "taper-angle");
}

#[test]
fn where_the_control_offsets_the_path_is_the_contour() {
    let plan = planned(punch(), &Settings { by_control: true, tab: 3.0, ..settings(&[0.2, 0.1]) });
    holds_together(&plan.passes);
    let corners = plan.passes[0].path.lower().elements().iter().map(|e| e.end);
    assert!(corners.clone().any(|end| end == p(30.0, 20.0)));
    // It is checked as if we offset.
    let inside = Opening { thread: Some(p(15.0, 10.0)), ..punch() };
    assert_eq!(rule(inside, &Settings { by_control: true, ..settings(&[0.15]) }), "cuts-part");
}

/// Across the first side stands the last one, when the start is its corner.
#[test]
fn a_die_that_starts_in_its_corner_is_cut_from_the_middle_of_a_long_side() {
    let round = Settings { corners: Corners::Round, ..settings(&[0.15]) };
    let plan = planned(opening(plate(), Side::Inside), &round);
    let path = plan.passes[0].path.lower();
    assert_eq!(path.start(), p(15.0, 5.0));
    assert!(path.elements()[0].end.distance(p(15.0, 0.15)) < 1e-9);
    // Outside nothing is in the path.
    let plan = planned(opening(plate(), Side::Outside), &round);
    assert_eq!(plan.passes[0].path.lower().start(), p(0.0, -5.0));
}

#[test]
fn a_lead_that_cuts_the_part_is_reported_with_the_line_of_its_contour() {
    let inside = Opening { thread: Some(p(15.0, 10.0)), ..punch() };
    let found = plan(&[inside], &settings(&[0.15])).unwrap_err();
    assert_eq!((found.rule.name(), found.line), ("cuts-part", 1));
}

#[test]
fn what_cannot_be_is_refused() {
    let open = Contour::new(plate().elements()[..3].to_vec(), 0.0).unwrap();
    assert_eq!(rule(opening(open.clone(), Side::Inside), &settings(&[0.1])), "open-contour");
    let tab = Settings { tab: 1.0, ..settings(&[0.1]) };
    assert_eq!(rule(opening(open.clone(), Side::Left), &tab), "open-contour");
    assert_eq!(rule(punch(), &Settings { tab: 101.0, ..settings(&[0.1]) }), "tab");
    assert_eq!(rule(punch(), &Settings { tab: -1.0, ..settings(&[0.1]) }), "tab");
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let lead = Lead { length: 5.0, shape: LeadShape::Arc(bad) };
        assert_eq!(rule(punch(), &Settings { lead, ..settings(&[0.1]) }), "lead");
        let lead = Lead { length: bad, shape: LeadShape::Straight };
        assert_eq!(rule(punch(), &Settings { lead, ..settings(&[0.1]) }), "lead");
    }
    let lead = Lead { length: 0.0, shape: LeadShape::Straight };
    let nowhere = Opening { thread: None, ..punch() };
    assert_eq!(rule(nowhere, &Settings { lead, ..settings(&[0.1]) }), "no-thread");
    for offsets in [&[][..], &[-0.1], &[f64::NAN], &[0.1, 0.2]] {
        assert_eq!(rule(punch(), &settings(offsets)), "passes");
    }
    let still = Settings { passes: vec![Cut { offset: 0.1, feed: 0.0 }], ..settings(&[]) };
    assert_eq!(rule(punch(), &still), "passes");
    assert_eq!(rule(opening(plate(), Side::Inside), &settings(&[0.1])), "inner-corner");
}

/// What the rough pass leaves in a corner of 0.18 mm the trim pass takes.
#[test]
fn only_the_last_pass_has_to_reach_the_corners() {
    let r = 0.18;
    let elements = vec![
        Element::line(p(0.0, 10.0), p(0.0, r)),
        Element::arc(p(0.0, r), p(r, 0.0), p(r, r), PI / 2.0),
        Element::line(p(r, 0.0), p(10.0, 0.0)),
    ];
    let corner = opening(Contour::new(elements, 0.0).unwrap(), Side::Left);
    assert!(plan(std::slice::from_ref(&corner), &settings(&[0.25, 0.15])).is_ok());
    assert_eq!(rule(corner, &settings(&[0.25, 0.2])), "inner-corner");
}

/// Threaded straight out from a corner, the wire reaches it by the shortest path.
#[test]
fn a_cut_may_start_at_a_corner() {
    let corner = Opening { thread: Some(p(-3.0, -4.0)), ..opening(plate(), Side::Outside) };
    let plan = planned(corner, &settings(&[0.15]));
    let entry = plan.passes[0].path.lower().elements()[0].end;
    assert!(entry.distance(p(-0.09, -0.12)) < 1e-9, "{entry}");
    let default = planned(opening(plate(), Side::Outside), &settings(&[0.15]));
    assert_eq!(default.passes[0].path.lower().start(), p(0.0, -5.0));
    assert!(default.passes[0].path.lower().elements()[0].end.distance(p(0.0, -0.15)) < 1e-9);
}

/// Along an open contour: there, back, there.
#[test]
fn an_open_contour_is_cut_there_and_back() {
    let line = Contour::new(vec![Element::line(p(0.0, 0.0), p(10.0, 0.0))], 0.0).unwrap();
    let plan = planned(opening(line, Side::Left), &settings(&[0.2, 0.1]));
    holds_together(&plan.passes);
    let ends = |i: usize| (plan.passes[i].path.lower().start(), plan.passes[i].path.lower().end());
    assert_eq!(ends(0), (p(0.0, 0.2), p(10.0, 0.2)));
    assert_eq!(ends(1), (p(10.0, 0.2), p(0.0, 0.1)));
    assert!(plan.passes[0].left && !plan.passes[1].left);
}

/// Taper by so many mm over a height of 40 mm.
fn leaned(mm: f64, rounding: Rounding) -> Option<Taper> {
    Some(Taper { angle: (mm / 40.0).atan(), height: 40.0, rounding })
}

/// What is sharp below is sharp above: the wire goes round the corner of the upper face as it does round that of the lower
/// one, by an arc of its own offset, which is 0.15 mm over the cosine of the angle.
#[test]
fn a_punch_with_sharp_corners_leans_either_way_and_keeps_them_sharp() {
    for (aside, start) in [(2.0, None), (-2.0, None), (-2.0, Some(p(30.0, 20.0)))] {
        for rounding in [Rounding::Conical, Rounding::Constant] {
            let settings = Settings { taper: leaned(aside, rounding), ..settings(&[0.2, 0.15]) };
            let punch = Opening { start, ..opening(plate(), Side::Outside) };
            let plan = planned(punch, &settings);
            let last = plan.passes.last().unwrap();
            let r = 0.15 / f64::atan(2.0 / 40.0).cos();
            let radii = last.path.upper().unwrap().elements().iter().filter_map(|e| e.radius());
            assert!(radii.clone().all(|radius| (radius - r).abs() < 1e-9) && radii.count() >= 4);
            let (w, h) = (30.0 + 2.0 * aside, 20.0 + 2.0 * aside);
            let expected = w * h + 2.0 * (w + h) * r + PI * r * r;
            let area = last.path.upper().unwrap().area().abs();
            assert!((area - expected).abs() < 1e-6, "{aside} {rounding:?}: {area} {expected}");
        }
    }
}

/// The sharp end between a line and an arc: 3 mm aside the circle of 10 about the origin has 7 mm, and crosses y = 3 at √40.
#[test]
fn a_sharp_corner_at_an_arc_goes_to_where_line_and_circle_cross_above() {
    let half = vec![
        Element::line(p(-10.0, 0.0), p(10.0, 0.0)).from_line(1),
        Element::arc(p(10.0, 0.0), p(-10.0, 0.0), Vec2::ZERO, PI).from_line(2),
    ];
    let half = Contour::new(half, 0.0).unwrap();
    let settings = Settings { taper: leaned(-3.0, Rounding::Conical), ..settings(&[0.15]) };
    let plan = planned(opening(half, Side::Outside), &settings);
    let upper = plan.passes[0].path.upper().unwrap();
    let centers: Vec<Vec2> =
        upper.elements().iter().filter_map(|e| e.turn).map(|t| t.center).collect();
    for corner in [p(40f64.sqrt(), 3.0), p(-(40f64.sqrt()), 3.0)] {
        assert!(centers.iter().any(|center| center.distance(corner) < 1e-9), "{centers:?}");
    }
}

/// An opening whose upper edge lies 2 mm nearer to where the wire is threaded.
#[test]
fn a_lead_shorter_than_the_wire_leans_is_refused_with_one_that_has_room() {
    let die = |thread, start| Opening { thread, start, ..opening(plate(), Side::Inside) };
    let taper = leaned(-2.0, Rounding::Conical);
    let narrow = Settings { taper, corners: Corners::Round, ..settings(&[0.15]) };
    let with =
        |length| Settings { lead: Lead { length, shape: LeadShape::Straight }, ..narrow.clone() };
    let refused = plan(&[die(None, None)], &with(1.0)).unwrap_err();
    assert_eq!(
        (refused.rule.name(), refused.help.as_str()),
        ("taper-lead", "there is room with --lead 2.4")
    );
    assert_eq!(planned(die(None, None), &with(2.4)).passes.len(), 1);
    // 1 mm from the lower edge, and so in the part above: the lower end goes to the edge, the upper one away from it.
    let refused = plan(&[die(Some(p(5.0, 1.0)), Some(p(15.0, 0.0)))], &narrow).unwrap_err();
    assert_eq!(refused.rule.name(), "taper-lead");
    assert!(refused.message.contains("the ends move against each other"), "{refused}");
    assert_eq!(
        refused.help,
        "there is room with --begin 15.0000,0.0000 --lead 5 and without --thread"
    );
    assert_eq!(planned(die(None, Some(p(15.0, 0.0))), &with(5.0)).passes.len(), 1);
    // Wider above, the same places do.
    let wide = Settings { taper: leaned(2.0, Rounding::Conical), ..narrow };
    assert_eq!(planned(die(Some(p(5.0, 1.0)), Some(p(15.0, 0.0))), &wide).passes.len(), 1);
}

/// The contour begins with a fillet of 0.1 mm, into which a wire at 0.15 mm does not go.
#[test]
fn a_cut_does_not_begin_on_a_fillet_that_is_smaller_than_the_wire() {
    let fillet = vec![
        Element::arc(p(0.0, 0.1), p(0.1, 0.0), p(0.1, 0.1), PI / 2.0),
        Element::line(p(0.1, 0.0), p(30.0, 0.0)),
        Element::line(p(30.0, 0.0), p(30.0, 20.0)),
        Element::line(p(30.0, 20.0), p(0.0, 20.0)),
        Element::line(p(0.0, 20.0), p(0.0, 0.1)),
    ];
    let contour = Contour::new(fillet, 0.0).unwrap();
    let round = Settings { corners: Corners::Round, ..settings(&[0.15]) };
    let made = planned(opening(contour.clone(), Side::Inside), &round);
    assert!(made.passes[0].path.lower().elements()[0].end.distance(p(15.0, 19.85)) < 0.2);
    // Where somebody asks for it, the message says where else.
    let begun = Opening { start: Some(p(0.0, 0.1)), ..opening(contour, Side::Inside) };
    let refused = plan(&[begun], &round).unwrap_err();
    assert_eq!(refused.rule.name(), "cuts-part");
    assert_eq!(refused.help, "there is room with --begin 15.0000,20.0000 --lead 5");
}
