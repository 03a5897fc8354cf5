//! The ground line of a panel and the coordinates it defines: along it and above it.

/// A line in plate px with a unit direction to the right and a unit normal upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GroundLine {
    origin_px: [f64; 2],
    along: [f64; 2],
}

impl GroundLine {
    /// Through two distinct points, the first on the left.
    pub(crate) fn through([a, b]: [[f64; 2]; 2]) -> Self {
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        Self { origin_px: a, along: [dx / length, dy / length] }
    }

    /// Unit vector along the line, to the right.
    pub(crate) fn along(&self) -> [f64; 2] {
        self.along
    }

    /// Unit vector upwards (image y points down).
    pub(crate) fn up(&self) -> [f64; 2] {
        [self.along[1], -self.along[0]]
    }

    /// Coordinates along and above the line, px; along is measured from the line's first point.
    pub(crate) fn along_and_above(&self, point_in_plate_px: [f64; 2]) -> [f64; 2] {
        let d = [0, 1].map(|axis| point_in_plate_px[axis] - self.origin_px[axis]);
        let up = self.up();
        [d[0] * self.along[0] + d[1] * self.along[1], d[0] * up[0] + d[1] * up[1]]
    }

    /// The point on the line at a distance along it.
    pub(crate) fn point_at(&self, along_px: f64) -> [f64; 2] {
        [0, 1].map(|axis| self.origin_px[axis] + along_px * self.along[axis])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn above_is_up_in_the_picture() {
        let line = GroundLine::through([[10.0, 100.0], [20.0, 110.0]]);
        let [along, above] = line.along_and_above([10.0, 80.0]);
        assert!(above > 0.0 && along < 0.0);
        let [ax, ay] = line.point_at(along);
        let up = line.up();
        assert!((ax + above * up[0] - 10.0).abs() < 1e-12 && (ay + above * up[1] - 80.0).abs() < 1e-12);
    }
}
