//! Any bytes as a body, a drawing or a list of points, in the form that the first byte chooses: no panic, and what is refused says where to go.
#![no_main]

use glass::curve::{self, Layers};
use glass::list::Columns;
use glass::mesh::{Form, Shape, read_painted};
use libfuzzer_sys::fuzz_target;

const FORMS: [Form; 5] =
    [Form::Stl, Form::Obj, Form::Ply, Form::ThreeMf, Form::List(Columns([0, 1, 2]))];

fuzz_target!(|data: &[u8]| {
    let Some((first, bytes)) = data.split_first() else { return };
    let drawings = [curve::Form::Dxf, curve::Form::Hpgl];
    let number = usize::from(*first) % (FORMS.len() + drawings.len());
    let read = match drawings.get(number.wrapping_sub(FORMS.len())) {
        Some(form) => curve::read(bytes, *form, "fuzz").map(Shape::Curves),
        // What a body names is the body itself: its materials stand between its faces.
        None => read_painted(bytes, FORMS[number], "fuzz", Some(&mut |_| Ok(bytes.to_vec()))),
    };
    match read {
        Ok(Shape::Mesh(mesh)) => {
            let count = mesh.vertices.len();
            assert!(mesh.triangles.iter().flatten().all(|corner| (*corner as usize) < count));
            mesh.health();
            let light = (0..mesh.triangles.len() as u32).map(|i| mesh.light(i, mesh.corners(i)[0]));
            assert!(
                mesh.paint.is_empty()
                    || light.take(100).all(|light| light.is_nan() || light >= 0.0)
            );
        }
        Ok(Shape::Points(points)) => assert!(points.iter().all(|point| point.is_finite())),
        Ok(Shape::Curves(curves)) => {
            let all = curves.curves.iter().flat_map(|curve| &curve.corners);
            assert!(all.clone().all(|corner| corner.is_finite()));
            // A step that leaves a few points, however large the drawing is.
            let size = all.map(|corner| corner.abs().max_element()).fold(1.0, f64::max);
            let corners = curves.curves.iter().map(|curve| &curve.corners[..]).take(20);
            Layers::default().points(
                corners,
                size / 10.0,
                1.0,
                glass::fill::direction(2, [0.0; 3]),
            );
        }
        Ok(Shape::Picture(_)) => unreachable!("no form of this reader is one"),
        Err(found) => assert!(found.is_error() && !found.help.is_empty()),
    }
});
