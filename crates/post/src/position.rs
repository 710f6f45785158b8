//! Where the tool is: the last pose of the source, and what the control knows of it.

use geom::Vec3;
use program::Pose;

/// Where the tool is.
#[derive(Debug, Default)]
pub(crate) struct ToolPosition {
    /// The last pose of the source.
    pose: Option<Pose>,
    /// Whether the control stands where the last pose says.
    located: bool,
    /// Where the tool was before it went home for a stop.
    left: Option<Pose>,
    /// Where the next block brings the tool tip, mm, work frame.
    tip: Vec3,
    /// The same in the coordinates of the block, mm.
    said: Vec3,
    /// Where the last arc leads, in the coordinates of the block, where its words give its angle.
    turned_to: Option<Vec3>,
    /// Tip and degrees of A, B, C that were checked last, where the control moves the linear axes along with the rotary axes.
    checked: Option<(Vec3, [f64; 3])>,
    /// Length of the path of the tip in the cut of the source at hand, mm.
    cut_length: f64,
}

impl ToolPosition {
    /// The last pose of the source, wherever the control stands.
    #[inline]
    pub(crate) fn pose(&self) -> Option<Pose> {
        self.pose
    }

    /// Where the tool is, where the control stands at a pose.
    #[inline]
    pub(crate) fn known(&self) -> Option<Pose> {
        self.pose.filter(|_| self.located)
    }

    /// Whether the control stands where the last pose says, or where a probe has answered.
    #[inline]
    pub(crate) fn is_located(&self) -> bool {
        self.located
    }

    /// Whether the tool is where a probe has answered, which only the machine knows.
    #[inline]
    pub(crate) fn is_probed(&self) -> bool {
        self.located && self.pose.is_none()
    }

    /// How far it is to `point` from the last pose, mm; 0 where there is none.
    #[inline]
    pub(crate) fn distance(&self, point: Vec3) -> f64 {
        self.pose.map_or(0.0, |pose| pose.point().distance(point))
    }

    /// Goes on to `pose`; the pose before. Whether the control stood there stays as it was.
    #[inline]
    pub(crate) fn go_to(&mut self, pose: Pose) -> Option<Pose> {
        self.pose.replace(pose)
    }

    /// The control stands where the last pose says.
    pub(crate) fn locate(&mut self) {
        self.located = true;
    }

    /// A probing move has ended where the probe has answered.
    pub(crate) fn probe(&mut self) {
        self.pose = None;
    }

    /// The control stands somewhere else: what it is sent next is said in full.
    pub(crate) fn lose(&mut self) {
        (self.located, self.turned_to, self.checked) = (false, None, None);
    }

    /// The tool has been changed: it is at the place of the changer.
    pub(crate) fn change_tool(&mut self) {
        (self.located, self.turned_to) = (false, None);
    }

    /// The tool has gone home for a stop from `left`, and comes back there before the next cut.
    pub(crate) fn leave(&mut self, left: Option<Pose>) {
        self.left = left;
    }

    /// Where the tool comes back to, once; nothing where something has moved since.
    pub(crate) fn come_back(&mut self) -> Option<Pose> {
        self.left.take().filter(|_| !self.located)
    }

    /// The next block brings the tip to `tip`, which is `said` in its coordinates, mm.
    #[inline]
    pub(crate) fn aim(&mut self, tip: Vec3, said: Vec3) {
        (self.tip, self.said) = (tip, said);
    }

    /// Where the next block brings the tool tip, mm, work frame.
    #[inline]
    pub(crate) fn tip(&self) -> Vec3 {
        self.tip
    }

    /// Where the next block brings the tool, in its coordinates, mm.
    #[inline]
    pub(crate) fn said(&self) -> Vec3 {
        self.said
    }

    /// Where the last arc leads, in the coordinates of its block, where its words give its angle.
    pub(crate) fn turned_to(&self) -> Option<Vec3> {
        self.turned_to
    }

    /// An arc leads there, whose words give its angle; nothing where its words give its end.
    pub(crate) fn turn_to(&mut self, end: Option<Vec3>) {
        self.turned_to = end;
    }

    /// The tip that has been aimed is checked with these degrees of A, B, C; what was checked before it.
    pub(crate) fn check(&mut self, degrees: [f64; 3]) -> Option<(Vec3, [f64; 3])> {
        self.checked.replace((self.tip, degrees))
    }

    /// Length of the path of the tip in the cut of the source at hand, mm; 0 where each move is a cut of its own.
    #[inline]
    pub(crate) fn cut_length(&self) -> f64 {
        self.cut_length
    }

    /// A cut of the source of this length, mm, begins.
    #[inline]
    pub(crate) fn begin_cut(&mut self, length: f64) {
        self.cut_length = length;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_is_known_only_where_the_control_stands_there() {
        let mut position = ToolPosition::default();
        let pose = Pose::new(Vec3::X, Vec3::Z).unwrap();
        position.go_to(pose);
        assert_eq!((position.pose(), position.known()), (Some(pose), None));
        position.locate();
        assert_eq!(position.known(), Some(pose));
        position.probe();
        assert!(position.is_probed() && position.known().is_none());
    }

    #[test]
    fn the_tool_comes_back_once_and_only_from_home() {
        let pose = Pose::new(Vec3::X, Vec3::Z).unwrap();
        let mut position = ToolPosition::default();
        position.leave(Some(pose));
        assert_eq!((position.come_back(), position.come_back()), (Some(pose), None));
        position.leave(Some(pose));
        position.locate();
        assert_eq!(position.come_back(), None, "something has moved since");
    }
}
