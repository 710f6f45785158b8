//! What every language needs: the kernel under the controls. It knows no language and no word of one.
//!
//! A text is read: [`decimal`] numbers, and [`folders`] in which called programs are looked for. It runs: a [`budget`] ends
//! endless loops. It moves: a [`corner`] is put between two segments, a rotary [`way`] is certain or not, and
//! [`compensation`] leads the tool's centre. It reports: [`belt`] takes batches from one thread to another, and
//! [`relay`] a whole control's events.

pub(crate) mod belt;
pub(crate) mod budget;
pub(crate) mod compensation;
pub(crate) mod corner;
pub(crate) mod decimal;
pub(crate) mod expression;
pub(crate) mod flow;
pub(crate) mod folders;
pub(crate) mod relay;
pub(crate) mod way;
