//! Systems of linear equations.

/// The combination of `columns` that makes `right`, by elimination with row pivots; `None` where a pivot is below `least`, which says
/// that the columns are no base, or too near to none.
pub fn solve<const N: usize>(
    columns: &[[f64; N]; N],
    mut right: [f64; N],
    least: f64,
) -> Option<[f64; N]> {
    let mut rows: [[f64; N]; N] =
        std::array::from_fn(|row| std::array::from_fn(|column| columns[column][row]));
    for pivot in 0..N {
        let size = |row: &usize| rows[*row][pivot].abs();
        let best = (pivot..N).max_by(|a, b| size(a).total_cmp(&size(b)))?;
        rows.swap(pivot, best);
        right.swap(pivot, best);
        let head = rows[pivot];
        // Neither is a number that is none.
        if head[pivot].is_nan() || head[pivot].abs() < least {
            return None;
        }
        for row in pivot + 1..N {
            let part = rows[row][pivot] / head[pivot];
            rows[row].iter_mut().zip(head).for_each(|(value, above)| *value -= part * above);
            right[row] -= part * right[pivot];
        }
    }
    for row in (0..N).rev() {
        let known: f64 = (row + 1..N).map(|column| rows[row][column] * right[column]).sum();
        right[row] = (right[row] - known) / rows[row][row];
    }
    Some(right)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// What the columns make of `parts`.
    fn made<const N: usize>(columns: &[[f64; N]; N], parts: &[f64; N]) -> [f64; N] {
        std::array::from_fn(|row| (0..N).map(|column| columns[column][row] * parts[column]).sum())
    }

    #[test]
    fn two_lines_cross_where_a_sketch_has_them() {
        // 2x + y = 5 and x - 3y = -1: (2, 1). The first pivot is 0 where the rows are the other way about.
        assert_eq!(solve(&[[2.0, 1.0], [1.0, -3.0]], [5.0, -1.0], 1e-9), Some([2.0, 1.0]));
        assert_eq!(solve(&[[0.0, 1.0], [1.0, 0.0]], [3.0, 4.0], 1e-9), Some([4.0, 3.0]));
    }

    #[test]
    fn columns_that_are_no_base_have_no_solution() {
        assert_eq!(solve(&[[1.0, 2.0], [2.0, 4.0]], [1.0, 2.0], 1e-9), None);
        assert_eq!(solve(&[[0.0; 6]; 6], [1.0; 6], 1e-9), None);
        assert_eq!(solve(&[[f64::NAN, 1.0], [1.0, 1.0]], [1.0, 1.0], 1e-9), None);
        // The third column is the sum of the first two, of a matrix that has no zero.
        let columns = [[1.0, 2.0, 4.0], [3.0, -1.0, 5.0], [4.0, 1.0, 9.0]];
        assert_eq!(solve(&columns, [1.0, 1.0, 1.0], 1e-9), None);
    }

    proptest! {
        #[test]
        fn the_residual_of_six_equations_is_as_small_as_rounding(
            cells in prop::array::uniform6(prop::array::uniform6(-1.0..1.0f64)),
            right in prop::array::uniform6(-1.0..1.0f64),
        ) {
            if let Some(parts) = solve(&cells, right, 1e-6) {
                let largest = parts.iter().fold(1.0f64, |most, part| most.max(part.abs()));
                for (found, wanted) in made(&cells, &parts).iter().zip(right) {
                    prop_assert!((found - wanted).abs() < 1e-13 * largest, "{found} {wanted}");
                }
            }
        }
    }
}
