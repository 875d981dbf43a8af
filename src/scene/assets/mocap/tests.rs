//! Motion capture that is well written, oddly written and broken.

use super::parse;
use crate::geometry::skeleton::{Freedom, Placement, Turning};
use crate::math::Affine;
use glam::DVec3;

const TWO_JOINTS: &str = "HIERARCHY
ROOT Hips
{
  OFFSET 1 2 3
  CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
  JOINT Left Leg:a
  {
    OFFSET 0 -4 0
    CHANNELS 3 Xrotation Zrotation Yrotation
    End Site
    {
      OFFSET 0 -5 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.5
1 0 0 90 0 0  10 20 30
2 0 0 90 0 0  10 20 30
";

fn message(text: &str) -> String {
    parse(text, |_| false).expect_err("it is broken").to_string()
}

#[test]
fn channels_in_any_order_turn_as_they_stand() {
    let (skeleton, motion) = parse(TWO_JOINTS, |_| false).unwrap();
    assert_eq!(skeleton.joints()[0].freedom, Freedom::Free);
    assert_eq!(skeleton.joints()[1].name, "Left_Leg_a");
    assert_eq!(skeleton.tips()[0].name, "Left_Leg_a_end");
    // By axis: x, y, z, whatever the order in the file.
    let angles = skeleton.coordinates_of(1, Turning::Turn).into_iter().map(|c| motion.frames[0][c]);
    assert_eq!(angles.collect::<Vec<_>>(), [10.0, 30.0, 20.0]);
    let placement = Placement::new(&skeleton, &motion.frames[0]);
    assert_eq!(placement.joint(1), DVec3::new(2.0 + 4.0, 2.0, 3.0));
    let turn = Affine::rotate(DVec3::Y, 30.0)
        .then(&Affine::rotate(DVec3::Z, 20.0))
        .then(&Affine::rotate(DVec3::X, 10.0))
        .then(&Affine::rotate(DVec3::Z, 90.0));
    let end = placement.joint(1) + turn.point(DVec3::Y * -5.0);
    assert!((placement.tip(&skeleton, 0) - end).length() < 1e-14);
    assert_eq!(motion.at(0.25)[0], 1.5);
}

#[test]
fn names_are_made_fit_and_told_apart() {
    let text = TWO_JOINTS.replace("Left Leg:a", "Hips");
    let (skeleton, _) = parse(&text, |name| name == "Hips_end").unwrap();
    assert_eq!(skeleton.joints()[1].name, "Hips_2");
    let text = TWO_JOINTS.replace("Hips", "3 way");
    assert_eq!(parse(&text, |_| false).unwrap().0.joints()[0].name, "_3_way");
    let text = TWO_JOINTS.replace("Hips", "residual");
    assert_eq!(parse(&text, |name| name == "residual").unwrap().0.joints()[0].name, "residual_");
}

#[test]
fn what_is_broken_is_said_with_its_line() {
    let broken = |from: &str, to: &str| message(&TWO_JOINTS.replace(from, to));
    assert_eq!(message(""), "line 1: the file ends where `HIERARCHY` is expected");
    assert_eq!(message("PK\u{3}\u{4}"), "line 1: `HIERARCHY` is expected, and this is `PK\u{3}\u{4}`");
    assert_eq!(
        broken("OFFSET 0 -4 0", "OFFSET 0 nan 0"),
        "line 8: a number of the offset is expected, and this is `nan`"
    );
    assert_eq!(
        broken("CHANNELS 3", "CHANNELS 4"),
        "line 10: `Xposition` … `Zrotation` is expected, and this is `End`"
    );
    assert_eq!(broken("3 Xrotation Z", "3 Yrotation Z"), "line 9: the channel `Yrotation` is given twice");
    assert_eq!(
        broken("Frames: 2", "Frames: 4000000000"),
        "line 18: 4000000000 frames of 9 channels are announced, and 18 numbers follow"
    );
    assert_eq!(
        broken("Frames: 2", "Frames: -2"),
        "line 17: the number of frames is expected, and this is -2"
    );
    assert_eq!(broken("Frames: 2", "Frames: 0"), "line 18: there is no frame");
    assert_eq!(broken("0.5\n", "0\n"), "line 18: the time of a frame must be above 0");
    assert_eq!(
        broken("2 0 0 90", "2 0 inf 90"),
        "line 20: a number of a frame is expected, and this is `inf`"
    );
    assert_eq!(broken("MOTION", "}"), "line 16: `ROOT` or `MOTION` is expected, and this is `}`");
    assert_eq!(
        broken("  End Site", "  Frames"),
        "line 10: `JOINT`, `End Site` or `}` is expected, and this is `FRAMES`"
    );
}

#[test]
fn a_file_cut_anywhere_or_nested_without_end_is_refused() {
    for end in 0..TWO_JOINTS.trim_end().len() {
        let cut = TWO_JOINTS.get(..end).unwrap();
        // The last number may be cut to another number.
        assert!(parse(cut, |_| false).is_err() || end + 2 > TWO_JOINTS.trim_end().len(), "{end}");
    }
    let deep = "JOINT a { OFFSET 0 0 0 ".repeat(100_000);
    assert!(message(&format!("HIERARCHY ROOT r {{ {deep}")).contains("nested deeper"));
}
