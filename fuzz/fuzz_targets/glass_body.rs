//! Any bytes as a body or a list of points, in the form that the first byte chooses: no panic, and what is refused says where to go.
#![no_main]

use glass::list::Columns;
use glass::mesh::{Form, Shape, read};
use libfuzzer_sys::fuzz_target;

const FORMS: [Form; 5] =
    [Form::Stl, Form::Obj, Form::Ply, Form::ThreeMf, Form::List(Columns([0, 1, 2]))];

fuzz_target!(|data: &[u8]| {
    let Some((first, bytes)) = data.split_first() else { return };
    match read(bytes, FORMS[usize::from(*first) % FORMS.len()], "fuzz") {
        Ok(Shape::Mesh(mesh)) => {
            let count = mesh.vertices.len();
            assert!(mesh.triangles.iter().flatten().all(|corner| (*corner as usize) < count));
            mesh.health();
        }
        Ok(Shape::Points(points)) => assert!(points.iter().all(|point| point.is_finite())),
        Ok(Shape::Picture(_)) => unreachable!("no form of this reader is one"),
        Err(found) => assert!(found.is_error() && !found.help.is_empty()),
    }
});
