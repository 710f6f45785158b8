//! `toolpost prove`: any program, also one edited by hand, compared with the toolpath it should make.

use crate::answer::Answer;
use crate::args::Prove;
use crate::progress::Progress;
use app::prove::compare;
use app::report::{self, Digests};
use app::{Stop, Watch, files, toolpath};
use program::{Purpose, encoding};

/// Runs the program on the virtual control of the machine and compares.
pub fn run(args: &Prove, silent: bool) -> Result<Answer, Stop> {
    let machine = toolpath::machine_with(&args.machine, &args.option)?;
    let progress = Progress::new(2, silent);
    progress.step("reading");
    let against = args.against.as_path().into();
    let toolpath =
        toolpath::read(&against, false, &args.origin.origin(), Some(&machine), Purpose::Program)?;
    let text = files::read(&args.program)?;
    let file = files::name(&args.program);
    if encoding::is_utf_16(&text) {
        return Err(encoding::utf_16().file(file).into());
    }
    let read = encoding::without_mark(&text);
    let tolerances = args.closeness.tolerances();
    let mut account = compare(&toolpath, &machine, &file, read, &tolerances, &progress)?;
    match report::pair(&args.program, || Digests::of(&text, &toolpath, &machine)) {
        Ok(pair) => account.rows.extend(pair.map(|text| ("report", text))),
        Err(found) => account.findings.push(*found),
    }
    Ok(account.into())
}
