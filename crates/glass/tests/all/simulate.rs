//! Runs of programs, with pulses that make no point, a stop, and going on.

use toolpost_glass::control::{Run, read};
use toolpost_glass::engraver::{Event, Refused, Settled, State};
use toolpost_glass::machine::{Machine, library};
use toolpost_glass::proof::{Task, prove};
use toolpost_glass::simulate::{Events, seconds_of, simulate};

const PLAIN: Events =
    Events { from: 1, until: None, door: None, misses: 0.0, feedback: false, seed: 1 };

fn machine() -> Machine {
    let text = library("glass-xyz-100hz").unwrap().replace("\"numbered\"", "\"points\"");
    Machine::read(&text, "").unwrap()
}

/// 100 points 0.2 mm apart: two ticks from each to the next at 100 Hz and 7.5 m/s² (0.1875 mm are one).
fn row() -> Run {
    let text: String =
        (0..100).map(|i| format!("{:.3} 5.000 -5.000\n", 0.2 * f64::from(i))).collect();
    read(text.as_bytes(), &machine()).unwrap()
}

#[test]
fn a_run_takes_its_ticks_and_counts_its_points() {
    let made = simulate(&row(), &machine(), PLAIN);
    // 1 + 99 * 2 ticks.
    assert_eq!((made.seconds, made.predicted, made.unused), (1.99, 1.99, 99));
    assert_eq!((made.counted, made.fired, made.progress()), (100, 100, 1.0));
}

#[test]
fn a_run_that_is_stopped_says_where_to_go_on() {
    // In 1 s there are 100 ticks: the first pulse, and 49 more at two ticks each.
    let made = simulate(&row(), &machine(), Events { until: Some(1.0), ..PLAIN });
    assert_eq!((made.counted, made.next, made.seconds), (50, Some(51), 0.99));
    assert_eq!((made.progress(), made.predicted), (0.5, 1.99));
    let rest = simulate(&row(), &machine(), Events { from: 51, ..PLAIN });
    assert_eq!((rest.counted, rest.next, rest.seconds), (50, None, 0.99));
    // Beyond the last point there is nothing to do.
    assert_eq!(simulate(&row(), &machine(), Events { from: 500, ..PLAIN }).fired, 0);
}

#[test]
fn a_missed_pulse_is_fired_again_with_feedback_and_listed_without() {
    let missing = Events { misses: 0.2, ..PLAIN };
    let open = simulate(&row(), &machine(), missing);
    assert_eq!(open.counted + open.missed.len() as u64, 100);
    assert!((8..=35).contains(&open.missed.len()) && open.seconds == 1.99, "{open:?}");
    let closed = simulate(&row(), &machine(), Events { feedback: true, ..missing });
    assert_eq!(closed.counted + closed.missed.len() as u64, 100);
    // One more tick for each pulse that is fired again; four in vain are one of 625.
    assert!((closed.seconds - 1.99 - 0.01 * (closed.fired - 100) as f64).abs() < 1e-9);
    assert!(closed.fired > 108 && closed.missed.len() <= 2, "{closed:?}");
    // None makes a point: four pulses each.
    let none = simulate(&row(), &machine(), Events { misses: 1.0, feedback: true, ..PLAIN });
    assert_eq!((none.counted, none.fired, none.missed.len()), (0, 400, 100));
    // In motion the axes do not wait.
    let text = library("glass-xyz-100hz").unwrap().to_owned() + "runs = true\n";
    let flying = Machine::read(&text, "").unwrap();
    let mut program =
        String::from("N1 BEGIN BLOCK X20.000 Y20.000 Z30.000 POINTS 10\nN2 RUN X0.2 Y0 Z0\n");
    for i in 0..10 {
        program += &format!("N{} PULSE X{:.3} Y5.000 Z-5.000\n", i + 3, 1.0 + 0.2 * f64::from(i));
    }
    program += "N13 REST\nN14 END\n";
    let run = read(program.as_bytes(), &flying).unwrap();
    let none = simulate(&run, &flying, Events { misses: 1.0, feedback: true, ..PLAIN });
    assert_eq!((none.fired, none.seconds), (10, 0.1));
}

#[test]
fn the_file_of_statistics_has_what_that_of_the_source_has() {
    // 951782400 is 2000-02-29 00:00:00 UTC.
    assert_eq!(seconds_of("2000-02-29 00:00:00"), Some(951_782_400));
    assert_eq!(seconds_of("1970-01-01T00:00:00"), Some(0));
    for wrong in [
        "2001-02-29 00:00:00",
        "2001-13-01 00:00:00",
        "2001-01-01",
        "now",
        "2001-01-01 24:00:00",
        "2001-01-01 0:0",
    ] {
        assert_eq!(seconds_of(wrong), None, "{wrong}");
    }
    let made = simulate(&row(), &machine(), Events { until: Some(1.0), ..PLAIN });
    assert_eq!(
        made.text(951_782_399),
        "Duration: 0:00:01\nProgress: 50.0 %\nStart date: 2000-02-28 23:59:59\nPredicted end: 2000-02-29 00:00:01\nCounted points: 50 of 100\n"
    );
}

const SETTLED: Settled =
    Settled { taught: true, extents: true, material: true, sorted: true, tested: true };

#[test]
fn an_engraver_fires_only_after_all_is_settled_and_confirmed() {
    let unsettled = Settled { taught: false, sorted: false, ..SETTLED };
    let refused = State::Idle.after(Event::Check(unsettled)).unwrap_err();
    let missing = vec!["zero taught for the lens", "order of the points"];
    assert_eq!(refused, Refused::Unsettled(missing));
    // The chain of the specification (4.16), and nothing that leaves a step out.
    let chain = [
        (Event::Check(SETTLED), State::Checked),
        (Event::Confirm, State::Confirmed),
        (Event::Warn, State::Warned),
        (Event::Start, State::MovingToLoad),
        (Event::Arrive, State::WarmingUp),
        (Event::Warm, State::Running),
        (Event::Stop, State::Stopped),
        (Event::Continue, State::Running),
        (Event::End, State::Finished),
        (Event::Unload, State::MovingToSample),
        (Event::Arrive, State::Idle),
    ];
    let mut now = State::Idle;
    for (at, (event, expected)) in chain.iter().enumerate() {
        for (later, _) in chain.iter().skip(at + 1).filter(|(later, _)| later != event) {
            let skipped = now.after(*later);
            // A run may end at once, and a stopped one too.
            let may = now == State::Running && *later == Event::End;
            assert!(may || now == State::Stopped || skipped == Err(Refused::Now(now)), "{now:?}");
        }
        now = now.after(*event).unwrap();
        assert_eq!((now, now.fires()), (*expected, *expected == State::Running));
        // From each state the door leads to a fault, in which nothing but a reset goes on.
        for stop in [Event::OpenDoor, Event::EmergencyStop] {
            let fault = now.after(stop).unwrap();
            assert!(fault == State::Fault && !fault.fires());
            assert!(fault.after(Event::Continue).is_err() && fault.after(Event::Warm).is_err());
            assert_eq!(fault.after(Event::Reset), Ok(State::Idle));
        }
    }
}

#[test]
fn an_open_door_stops_a_run_which_goes_on_from_the_next_point() {
    // In 1 s there are 50 pulses (above); the door is opened before the stop that was asked for.
    let events = Events { until: Some(1.5), door: Some(1.0), ..PLAIN };
    let made = simulate(&row(), &machine(), events);
    assert_eq!((made.counted, made.next, made.states.last()), (50, Some(51), Some(&State::Fault)));
    let stopped =
        simulate(&row(), &machine(), Events { until: Some(1.0), door: Some(1.5), ..PLAIN });
    assert_eq!((stopped.next, stopped.states.last()), (Some(51), Some(&State::Stopped)));
    let whole = simulate(&row(), &machine(), Events { door: Some(60.0), ..PLAIN });
    assert_eq!((whole.next, whole.states.last()), (None, Some(&State::Idle)));
    assert!(whole.states.contains(&State::Finished) && whole.states[1] == State::Checked);
}

/// The proof of a program of points at depths in K9.
fn task<'a>(machine: &'a Machine, cloud: &'a [[i32; 3]]) -> Task<'a> {
    Task {
        cloud,
        machine,
        lens: machine.lens(70.0).unwrap(),
        index: 1.5195,
        block: [20.0, 20.0, 30.0],
        blocks: 1,
        spacing: 0.13,
        accept_shadowed: false,
    }
}

#[test]
fn the_travel_of_a_program_is_the_length_of_its_lines() {
    let machine = machine();
    // 5 mm of drive are 7.6 mm deep in K9 (Snell's law: 5 / 0.657873).
    let cloud = [[0, 5_000, 22_400], [3_000, 9_000, 22_400], [3_000, 10_000, 22_400]];
    let task = task(&machine, &cloud);
    let run = read(b"0.000 5.000 -5.000\n3.000 9.000 -5.000\n3.000 10.000 -5.000\n", &machine);
    let (proof, found) = prove(&run.unwrap(), &task).unwrap();
    // 3 and 4 mm are 5 mm, and 1 mm.
    assert_eq!((proof.travel, found.len()), (6.0, 0), "{found:?}");
}

#[test]
fn pulses_farther_off_than_can_be_counted_are_refused() {
    let machine = machine();
    let task = task(&machine, &[[10_000, 10_000, 15_000]]);
    // Each way is longer than 2^64 µm, and all of them together.
    let far = "5".repeat(50);
    let text = format!("0 0 0\n{far} 0 0\n-{far} 0 0\n{far} 0 0\n-{far} 0 0\n");
    let found = match read(text.as_bytes(), &machine) {
        Ok(run) => match prove(&run, &task) {
            Ok((_, found)) | Err(found) => found,
        },
        Err(found) => found,
    };
    assert!(found.iter().any(program::Diagnostic::is_error), "{found:?}");
}
