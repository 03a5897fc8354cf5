//! The normal matrix of the stride fit and its Cholesky factor.
//!
//! Panels form a ring in which each touches its two neighbours on either side, and all of them touch the shared
//! lengths. The last two panels of the ring and the lengths are taken as a border, which leaves a band of blocks:
//!
//! ```text
//! D0                    each column of blocks is stored as one tall matrix:
//! E0 D1                 diagonal, next, next but one, border
//! F0 E1 D2
//!    F1 E2 D3
//! B0 B1 B2 B3 C
//! ```

use nalgebra::{DMatrixView, DMatrixViewMut};

use crate::layout::{Layout, PANEL_DOF, SHARED};

const BORDER: usize = 2 * PANEL_DOF + SHARED;
const BAND: usize = 3 * PANEL_DOF;
const ROWS: usize = BAND + BORDER;
/// Entries of one column of blocks.
const BLOCK: usize = ROWS * PANEL_DOF;

/// Symmetric matrix of the band-and-border form; only the lower triangle is kept.
#[derive(Debug)]
pub struct NormalMatrix {
    /// Columns of blocks.
    blocks: usize,
    /// The columns of blocks, each column-major, then the corner: in one piece, because the solver copies whole
    /// matrices at each step.
    data: Vec<f64>,
}

impl Clone for NormalMatrix {
    fn clone(&self) -> Self {
        Self { blocks: self.blocks, data: self.data.clone() }
    }

    /// Keeps the memory: asking the system for a megabyte at each step costs a fifth of the step.
    fn clone_from(&mut self, other: &Self) {
        self.blocks = other.blocks;
        self.data.clone_from(&other.data);
    }
}

impl NormalMatrix {
    /// A zero matrix for a stride of at least four panels.
    pub fn zeros(layout: Layout) -> Self {
        assert!(layout.panels >= 4, "a cyclic second difference needs four panels");
        let blocks = layout.panels - 2;
        Self { blocks, data: vec![0.0; blocks * BLOCK + BORDER * BORDER] }
    }

    /// Number of unknowns.
    pub fn dimension(&self) -> usize {
        self.border() + BORDER
    }

    /// Index of the first unknown of the border.
    fn border(&self) -> usize {
        self.blocks * PANEL_DOF
    }

    /// Index into the data of entry `(i, j)`; `(i, j)` and `(j, i)` are the same one.
    fn place(&self, i: usize, j: usize) -> usize {
        let (row, column) = if i >= j { (i, j) } else { (j, i) };
        let border = self.border();
        if column >= border {
            return self.blocks * BLOCK + (column - border) * BORDER + row - border;
        }
        let start = column / PANEL_DOF * PANEL_DOF;
        debug_assert!(row >= border || row < start + BAND, "entry outside the band");
        column * ROWS + if row >= border { BAND + row - border } else { row - start }
    }

    /// Adds to an entry; `(i, j)` and `(j, i)` are the same one.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let place = self.place(i, j);
        self.data[place] += value;
    }

    /// Entry `(i, j)`.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.data[self.place(i, j)]
    }

    /// Adds the outer product of a sparse row with itself, times a weight.
    pub fn add_row(&mut self, row: &[(usize, f64)], weight: f64) {
        for (k, &(i, a)) in row.iter().enumerate() {
            let a = weight * a;
            self.add(i, i, a * row[k].1);
            for &(j, b) in &row[..k] {
                // An unknown that stands twice in a row contributes the cross term to the diagonal twice.
                self.add(i, j, if i == j { 2.0 * a * b } else { a * b });
            }
        }
    }

    /// The diagonal.
    pub fn diagonal(&self) -> Vec<f64> {
        (0..self.dimension()).map(|i| self.get(i, i)).collect()
    }

    /// The stored part of a column from its diagonal down: within the band, and in the border.
    fn column(&self, j: usize) -> [&[f64]; 2] {
        if let Some(c) = j.checked_sub(self.border()) {
            let column = &self.data[self.blocks * BLOCK + c * BORDER..][..BORDER];
            return [&[], &column[c..]];
        }
        let (c, start) = (j % PANEL_DOF, j - j % PANEL_DOF);
        let column = &self.data[j * ROWS..][..ROWS];
        [&column[c..BAND.min(self.border() - start)], &column[BAND..]]
    }

    /// Product with a vector.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        for j in 0..x.len() {
            let [band, border] = self.column(j);
            for (part, start) in [(band, j), (border, j.max(self.border()))] {
                let mut sum = 0.0;
                for ((value, x_i), y_i) in part.iter().zip(&x[start..]).zip(&mut y[start..]) {
                    *y_i += value * x[j];
                    sum += value * x_i;
                }
                y[j] += sum;
            }
            // The diagonal counted twice.
            y[j] -= self.get(j, j) * x[j];
        }
        y
    }

    /// Empties the row and column of each pinned unknown but for a one on the diagonal.
    fn pin(&mut self, pinned: &[bool]) {
        let border = self.border();
        for j in 0..self.dimension() {
            let start = j - j % PANEL_DOF;
            let band = if j < border { j..border.min(start + BAND) } else { j..j };
            for i in band.chain(j.max(border)..self.dimension()).filter(|i| pinned[*i] || pinned[j]) {
                let place = self.place(i, j);
                self.data[place] = if i == j { 1.0 } else { 0.0 };
            }
        }
    }

    /// Cholesky factor of the matrix with `damping` added to its diagonal and the pinned unknowns taken out; none
    /// when it is not positive definite.
    pub fn factor(&self, damping: &[f64], pinned: &[bool]) -> Option<Factor> {
        let mut factor = Factor::of_size(self);
        self.factor_into(damping, pinned, &mut factor)?;
        Some(factor)
    }

    /// The same in the memory of an older factor of the same size, whose content is lost even when there is no new one.
    pub(crate) fn factor_into(&self, damping: &[f64], pinned: &[bool], factor: &mut Factor) -> Option<()> {
        let work = &mut factor.lower;
        work.clone_from(self);
        for (i, value) in damping.iter().enumerate() {
            work.add(i, i, *value);
        }
        if pinned.iter().any(|p| *p) {
            work.pin(pinned);
        }
        let n = work.blocks;
        let (columns, corner) = work.data.split_at_mut(n * BLOCK);
        for block in 0..n {
            let (head, tail) = columns.split_at_mut((block + 1) * BLOCK);
            let column = &mut head[block * BLOCK..];
            eliminate(column, ROWS)?;
            // Rows of the next block, the next but one, and the border.
            let below = DMatrixView::from_slice(column, ROWS, PANEL_DOF);
            let below = below.rows(PANEL_DOF, ROWS - PANEL_DOF);
            let transposed = below.transpose();
            let border = below.rows(2 * PANEL_DOF, BORDER);
            for (ahead, target) in tail.chunks_exact_mut(BLOCK).take(2).enumerate() {
                let mut target = DMatrixViewMut::from_slice(target, ROWS, PANEL_DOF);
                let right = transposed.columns(ahead * PANEL_DOF, PANEL_DOF);
                let height = (2 - ahead) * PANEL_DOF;
                target.rows_mut(0, height).gemm(-1.0, &below.rows(ahead * PANEL_DOF, height), &right, 1.0);
                target.rows_mut(BAND, BORDER).gemm(-1.0, &border, &right, 1.0);
            }
            let right = transposed.columns(2 * PANEL_DOF, BORDER);
            DMatrixViewMut::from_slice(corner, BORDER, BORDER).gemm(-1.0, &border, &right, 1.0);
        }
        eliminate(corner, BORDER)
    }
}

/// Columns eliminated one by one before the rest is brought up to date by one matrix product.
const STRIP: usize = 11;

/// In-place Cholesky of the square head of a tall matrix, applied to the rows below it: `X <- X L^-T`.
fn eliminate(tall: &mut [f64], rows: usize) -> Option<()> {
    let n = tall.len() / rows;
    for start in (0..n).step_by(STRIP) {
        let end = n.min(start + STRIP);
        let (left, right) = tall.split_at_mut(end * rows);
        let strip = &mut left[start * rows..];
        eliminate_strip(strip, rows, start)?;
        if end < n {
            let strip = DMatrixView::from_slice(strip, rows, end - start);
            let (below, beside) = (strip.rows(end, rows - end), strip.rows(end, n - end).transpose());
            let mut rest = DMatrixViewMut::from_slice(right, rows, n - end);
            rest.rows_mut(end, rows - end).gemm(-1.0, &below, &beside, 1.0);
        }
    }
    Some(())
}

/// The same for the columns of a strip whose first diagonal entry is in row `start`.
fn eliminate_strip(strip: &mut [f64], rows: usize, start: usize) -> Option<()> {
    for k in start..start + strip.len() / rows {
        let (left, right) = strip.split_at_mut((k - start) * rows);
        let column = &mut right[k..rows];
        for before in left.chunks_exact(rows) {
            let factor = before[k];
            for (target, source) in column.iter_mut().zip(&before[k..]) {
                *target -= factor * source;
            }
        }
        let pivot = column[0];
        if !(pivot > 0.0 && pivot.is_finite()) {
            return None;
        }
        let scale = 1.0 / pivot.sqrt();
        column.iter_mut().for_each(|value| *value *= scale);
    }
    Some(())
}

/// Cholesky factor; solves systems with the matrix.
#[derive(Clone, Debug)]
pub struct Factor {
    lower: NormalMatrix,
}

impl Factor {
    /// Room for the factor of a matrix.
    pub(crate) fn of_size(matrix: &NormalMatrix) -> Self {
        Self { lower: matrix.clone() }
    }

    /// Solves for one right-hand side.
    pub fn solve(&self, right: &[f64]) -> Vec<f64> {
        let border = self.lower.border();
        let mut x = right.to_vec();
        for j in 0..x.len() {
            let [band, tail] = self.lower.column(j);
            x[j] /= self.lower.get(j, j);
            let value = x[j];
            let (band, tail) = below_diagonal(j, border, band, tail);
            subtract(&mut x[j + 1..], band, value);
            subtract(&mut x[border.max(j + 1)..], tail, value);
        }
        for j in (0..x.len()).rev() {
            let [band, tail] = self.lower.column(j);
            let (band, tail) = below_diagonal(j, border, band, tail);
            let sum = dot(&x[j + 1..], band) + dot(&x[border.max(j + 1)..], tail);
            x[j] = (x[j] - sum) / self.lower.get(j, j);
        }
        x
    }

    /// Diagonal of the inverse: variances, when the matrix is a normal matrix of unit-variance residuals.
    pub fn inverse_diagonal(&self) -> Vec<f64> {
        let n = self.lower.dimension();
        let mut unit = vec![0.0; n];
        (0..n)
            .map(|i| {
                unit[i] = 1.0;
                let column = self.solve(&unit);
                unit[i] = 0.0;
                column[i]
            })
            .collect()
    }
}

/// A column's two stored parts without the diagonal, which leads the one or the other.
fn below_diagonal<'a>(j: usize, border: usize, band: &'a [f64], tail: &'a [f64]) -> (&'a [f64], &'a [f64]) {
    if j < border { (&band[1..], tail) } else { (band, &tail[1..]) }
}

fn subtract(x: &mut [f64], column: &[f64], value: f64) {
    x.iter_mut().zip(column).for_each(|(x, c)| *x -= value * c);
}

fn dot(x: &[f64], column: &[f64]) -> f64 {
    x.iter().zip(column).map(|(x, c)| x * c).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    /// A random-looking matrix of the right pattern, and the same as a dense one.
    fn example(panels: usize) -> (NormalMatrix, DMatrix<f64>) {
        let layout = Layout { panels };
        let n = layout.dimension();
        let mut matrix = NormalMatrix::zeros(layout);
        let mut dense = DMatrix::zeros(n, n);
        let mut seed = 1u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) as f64 / (1u64 << 31) as f64 - 0.5
        };
        for slot in 0..panels {
            for _ in 0..80 {
                let other = (slot + (random().abs() * 6.0) as usize) % panels;
                let other = if (other + panels - slot) % panels <= 2 { other } else { slot };
                let pick = |r: f64, m: usize| ((r + 0.5) * m as f64) as usize;
                let row = [
                    (layout.panel(slot, pick(random(), PANEL_DOF)), random()),
                    (layout.panel(other, pick(random(), PANEL_DOF)), random()),
                    (layout.shared(pick(random(), SHARED)), random()),
                ];
                matrix.add_row(&row, 1.0);
                for &(i, a) in &row {
                    for &(j, b) in &row {
                        dense[(i, j)] += a * b;
                    }
                }
            }
        }
        for i in 0..n {
            matrix.add(i, i, 1.0);
            dense[(i, i)] += 1.0;
        }
        (matrix, dense)
    }

    #[test]
    fn factor_solves_what_a_dense_solver_solves() {
        for panels in [4, 5, 6, 11, 24] {
            let (matrix, dense) = example(panels);
            let right: Vec<f64> = (0..matrix.dimension()).map(|i| (i as f64 * 0.7).sin()).collect();
            let expected = dense.clone().cholesky().unwrap().solve(&DVector::from_vec(right.clone()));
            let found = matrix.factor(&[], &[]).unwrap().solve(&right);
            let error = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-9, "{panels} panels: {error}");
            let product = matrix.multiply(&found);
            let error = product.iter().zip(&right).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error < 1e-9, "{panels} panels: product off by {error}");
        }
    }

    #[test]
    fn pinned_unknowns_keep_their_right_hand_side_out_of_the_others() {
        let (matrix, mut dense) = example(6);
        let n = matrix.dimension();
        let pinned: Vec<bool> = (0..n).map(|i| i % 7 == 3).collect();
        let right: Vec<f64> = (0..n).map(|i| if pinned[i] { 0.0 } else { (i as f64).cos() }).collect();
        for i in (0..n).filter(|i| pinned[*i]) {
            dense.row_mut(i).fill(0.0);
            dense.column_mut(i).fill(0.0);
            dense[(i, i)] = 1.0;
        }
        let expected = dense.cholesky().unwrap().solve(&DVector::from_vec(right.clone()));
        let found = matrix.factor(&[], &pinned).unwrap().solve(&right);
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-9));
    }

    #[test]
    fn an_indefinite_matrix_has_no_factor() {
        let (mut matrix, _) = example(5);
        matrix.add(40, 40, -1e6);
        assert!(matrix.factor(&[], &[]).is_none());
    }
}
