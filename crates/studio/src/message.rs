//! Frames of the socket: a head in JSON, and arrays of numbers behind it.
//!
//! ```text
//! u32   length of the head, little-endian
//! ...   head, UTF-8
//! 0...  zeros up to a multiple of 8 from the start of the frame
//! ...   the arrays, each followed by zeros up to the next multiple of 8
//! ```
//!
//! `arrays` in the head says what they are, in the order of their bytes: `[{"name": "least", "type": "f32", "length": 640}]`.
//! Nothing is allocated that the frame does not hold: a frame takes as much memory as it has bytes, and as its head has as JSON.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// The largest frame that is read, bytes.
pub const MOST_BYTES: usize = 64 << 20;

/// The largest head, bytes.
pub const MOST_HEAD: usize = 1 << 20;

/// The most arrays of a frame.
const MOST_ARRAYS: usize = 64;

/// Numbers of one type.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Bytes: texts in UTF-8.
    U8(Vec<u8>),
    /// Numbers of moves and lines.
    U32(Vec<u32>),
    /// What is drawn.
    F32(Vec<f32>),
    /// What is measured.
    F64(Vec<f64>),
}

/// Numbers with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// What they are.
    pub name: String,
    /// The numbers.
    pub values: Values,
}

impl Array {
    /// Numbers with a name.
    pub fn new(name: impl Into<String>, values: Values) -> Array {
        Array { name: name.into(), values }
    }

    /// A text with a name.
    pub fn text(name: impl Into<String>, text: impl Into<Vec<u8>>) -> Array {
        Array::new(name, Values::U8(text.into()))
    }
}

/// A frame as it was read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// The head, without `arrays`.
    pub head: Map<String, Value>,
    /// The arrays.
    pub arrays: Vec<Array>,
}

impl Frame {
    /// The text of this name; empty where there is none.
    pub fn take_text(&mut self, name: &str) -> Option<Vec<u8>> {
        let at = self.arrays.iter().position(|array| array.name == name)?;
        match self.arrays.swap_remove(at).values {
            Values::U8(text) => Some(text),
            Values::U32(_) | Values::F32(_) | Values::F64(_) => None,
        }
    }
}

/// What a head says of an array.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Described {
    name: String,
    r#type: Type,
    length: usize,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Type {
    U8,
    U32,
    F32,
    F64,
}

impl Type {
    fn bytes(self) -> usize {
        match self {
            Type::U8 => 1,
            Type::U32 | Type::F32 => 4,
            Type::F64 => 8,
        }
    }
}

impl Values {
    fn described(&self) -> (Type, usize) {
        match self {
            Values::U8(values) => (Type::U8, values.len()),
            Values::U32(values) => (Type::U32, values.len()),
            Values::F32(values) => (Type::F32, values.len()),
            Values::F64(values) => (Type::F64, values.len()),
        }
    }

    fn append(&self, to: &mut Vec<u8>) {
        match self {
            Values::U8(values) => to.extend_from_slice(values),
            Values::U32(values) => to.extend(values.iter().flat_map(|value| value.to_le_bytes())),
            Values::F32(values) => to.extend(values.iter().flat_map(|value| value.to_le_bytes())),
            Values::F64(values) => to.extend(values.iter().flat_map(|value| value.to_le_bytes())),
        }
    }

    fn of(r#type: Type, bytes: &[u8]) -> Values {
        fn each<const N: usize, T>(bytes: &[u8], of: impl Fn([u8; N]) -> T) -> Vec<T> {
            bytes.as_chunks().0.iter().map(|chunk| of(*chunk)).collect()
        }
        match r#type {
            Type::U8 => Values::U8(bytes.to_vec()),
            Type::U32 => Values::U32(each(bytes, u32::from_le_bytes)),
            Type::F32 => Values::F32(each(bytes, f32::from_le_bytes)),
            Type::F64 => Values::F64(each(bytes, f64::from_le_bytes)),
        }
    }
}

/// The frame of a head, which is an object, and of arrays.
pub fn write(head: &impl Serialize, arrays: &[Array]) -> Vec<u8> {
    let mut head = match serde_json::to_value(head) {
        Ok(Value::Object(head)) => head,
        _ => Map::new(),
    };
    if !arrays.is_empty() {
        let described = arrays.iter().map(|array| {
            let (r#type, length) = array.values.described();
            serde_json::json!(Described { name: array.name.clone(), r#type, length })
        });
        head.insert(String::from("arrays"), described.collect());
    }
    let head = Value::Object(head).to_string();
    let length = u32::try_from(head.len()).unwrap_or(u32::MAX);
    let mut frame = Vec::with_capacity(head.len() + 12);
    frame.extend_from_slice(&length.to_le_bytes());
    frame.extend_from_slice(head.as_bytes());
    for array in arrays {
        pad(&mut frame);
        array.values.append(&mut frame);
    }
    pad(&mut frame);
    frame
}

fn pad(frame: &mut Vec<u8>) {
    frame.resize(frame.len().next_multiple_of(8), 0);
}

/// Takes a frame apart.
///
/// # Errors
/// What is wrong with it, as the end of the sentence "the message ...".
pub fn read(bytes: &[u8]) -> Result<Frame, &'static str> {
    if bytes.len() > MOST_BYTES {
        return Err("is larger than 64 MB");
    }
    let (length, rest) = bytes.split_first_chunk().ok_or("is shorter than 4 bytes")?;
    let length = u32::from_le_bytes(*length) as usize;
    if length > MOST_HEAD {
        return Err("has a head larger than 1 MB");
    }
    let head = rest.get(..length).ok_or("is shorter than its head")?;
    let mut head: Map<String, Value> =
        serde_json::from_slice(head).map_err(|_| "has a head that is no JSON object")?;
    let described = head.remove("arrays").unwrap_or(Value::Array(Vec::new()));
    let described: Vec<Described> =
        serde_json::from_value(described).map_err(|_| "describes its arrays wrongly")?;
    if described.len() > MOST_ARRAYS {
        return Err("has more than 64 arrays");
    }
    let mut at = 4 + length;
    let mut arrays = Vec::with_capacity(described.len());
    for Described { name, r#type, length } in described {
        at = at.next_multiple_of(8);
        let end = length.checked_mul(r#type.bytes()).and_then(|length| at.checked_add(length));
        let end = end.filter(|end| *end <= bytes.len()).ok_or("is shorter than its arrays")?;
        // What lies between two arrays is padding; `at` may lie behind the end where the array is empty.
        let values = Values::of(r#type, bytes.get(at..end).unwrap_or_default());
        arrays.push(Array { name, values });
        at = end;
    }
    if bytes.len() > at.next_multiple_of(8) {
        return Err("is longer than its arrays");
    }
    Ok(Frame { head, arrays })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// By hand: 4 bytes of length, 54 of the head, 6 zeros to 64, two numbers of 4 bytes.
    #[test]
    fn a_frame_is_what_the_front_page_says() {
        let head = r#"{"id":7,"arrays":[{"name":"n","type":"u32","length":2}]}"#;
        let mut bytes = vec![56, 0, 0, 0];
        bytes.extend_from_slice(head.as_bytes());
        bytes.extend_from_slice(&[0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0]);
        assert_eq!(bytes.len(), 72);
        let arrays = [Array::new("n", Values::U32(vec![1, 256]))];
        assert_eq!(write(&json!({ "id": 7 }), &arrays), bytes);
        let frame = read(&bytes).unwrap();
        assert_eq!(frame.head, *json!({ "id": 7 }).as_object().unwrap());
        assert_eq!(frame.arrays, arrays);
    }

    #[test]
    fn what_is_written_is_read() {
        let arrays = [
            Array::text("text", "G1 X1"),
            Array::new("none", Values::F64(Vec::new())),
            Array::new("f64", Values::F64(vec![0.1, -1e300])),
            Array::new("f32", Values::F32(vec![0.5, 1.5, 2.5])),
            Array::new("u32", Values::U32(vec![u32::MAX])),
        ];
        for some in 0..=arrays.len() {
            let bytes = write(&json!({ "ask": "x".repeat(some) }), &arrays[..some]);
            assert!(bytes.len().is_multiple_of(8));
            assert_eq!(read(&bytes).unwrap().arrays, arrays[..some]);
        }
    }

    #[test]
    fn a_broken_frame_is_refused_with_a_reason() {
        let framed = |head: &str, rest: &[u8]| {
            let mut bytes = (head.len() as u32).to_le_bytes().to_vec();
            bytes.extend_from_slice(head.as_bytes());
            bytes.extend_from_slice(rest);
            bytes
        };
        let array = |length: &str| {
            format!(r#"{{"arrays":[{{"name":"n","type":"f64","length":{length}}}]}}"#)
        };
        let many = format!(
            r#"{{"arrays":[{}]}}"#,
            [r#"{"name":"","type":"u8","length":0}"#; 65].join(",")
        );
        let deep = format!(r#"{{"a":{}"#, "[".repeat(100_000));
        for (bytes, why) in [
            (vec![1, 2], "is shorter than 4 bytes"),
            (vec![9, 0, 0, 0, b'{'], "is shorter than its head"),
            (vec![255, 255, 255, 255], "has a head larger than 1 MB"),
            (framed("[]", b""), "has a head that is no JSON object"),
            (framed("{", b""), "has a head that is no JSON object"),
            (framed(&deep, b""), "has a head that is no JSON object"),
            (framed("{\"a\":\"\u{1}\"}", b""), "has a head that is no JSON object"),
            (framed(r#"{"arrays":3}"#, b""), "describes its arrays wrongly"),
            (framed(&array("-1"), b""), "describes its arrays wrongly"),
            (framed(&array("1.5"), b""), "describes its arrays wrongly"),
            (framed(&array("2"), &[0; 12]), "is shorter than its arrays"),
            (framed(&array("18446744073709551615"), b""), "is shorter than its arrays"),
            (framed(&array("2305843009213693952"), b""), "is shorter than its arrays"),
            (framed(&many, b""), "has more than 64 arrays"),
            (framed(&array("0"), &[0; 64]), "is longer than its arrays"),
            (vec![0; MOST_BYTES + 1], "is larger than 64 MB"),
        ] {
            assert_eq!(read(&bytes), Err(why));
        }
    }

    /// A hundred thousand frames in which bytes are other ones, or that end early: none makes `read` panic, and what is read has no more
    /// than the frame.
    #[test]
    fn a_damaged_frame_is_read_or_refused() {
        let arrays = [
            Array::text("text", "G1 X1"),
            Array::new("f64", Values::F64(vec![0.1, f64::NAN])),
            Array::new("u32", Values::U32(vec![1, 2, 3])),
        ];
        let whole = write(&json!({ "id": 7, "ask": "post", "params": { "a": [1, "b"] } }), &arrays);
        let mut state = 1u64;
        let mut random = |below: usize| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) as usize % below
        };
        let mut read_well = 0;
        for _ in 0..100_000 {
            let mut bytes = whole.clone();
            for _ in 0..=random(3) {
                let at = random(bytes.len());
                bytes[at] = random(256) as u8;
            }
            bytes.truncate(whole.len() - random(4) * random(whole.len() / 4));
            let Ok(frame) = read(&bytes) else { continue };
            read_well += 1;
            let (length, again) = (bytes.len(), read(&write(&frame.head, &frame.arrays)).unwrap());
            assert_eq!(write(&(), &again.arrays), write(&(), &frame.arrays));
            assert!(write(&(), &frame.arrays).len() <= 2 * length);
        }
        assert!(read_well > 1000, "{read_well}");
    }
}
