//! What the models of the control differ in, each a table of facts; no other file of `sinumerik` asks for a model.

/// What one model reads otherwise than the others.
#[derive(Debug)]
pub(crate) struct Facts {
    /// Its name.
    pub name: &'static str,
    /// G commands that are settable work offsets of this model alone.
    pub own_offsets: &'static [u32],
    /// G commands that are settable work offsets of the other models, and the word for each here.
    pub offsets_elsewhere: &'static [(u32, u32)],
}

/// SINUMERIK 840D sl.
pub(crate) const S840D: Facts = Facts { name: "840D sl", own_offsets: &[], offsets_elsewhere: &[] };

/// SINUMERIK 828D: `G58` and `G59` are the fifth and the sixth offset (Fundamentals 12/2019, "Settable work offset").
pub(crate) const S828D: Facts =
    Facts { name: "828D", own_offsets: &[58, 59], offsets_elsewhere: &[(505, 58), (506, 59)] };
