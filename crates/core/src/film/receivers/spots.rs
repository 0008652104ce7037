// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Spots`]: round receivers, found by direction.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::math::DVec3;

/// A round receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// H of its middle, in rad.
    pub h: f64,
    /// V of its middle, in rad.
    pub v: f64,
    /// Half of the angle that it subtends, in rad.
    pub half_angle: f64,
}

impl Spot {
    fn direction(&self) -> DVec3 {
        let ((sin_h, cos_h), (sin_v, cos_v)) = (self.h.sin_cos(), self.v.sin_cos());
        DVec3::new(sin_h * cos_v, sin_v, cos_h * cos_v)
    }

    /// The range of V that it reaches into, and how far from its H it does; all round at a pole.
    fn extent(&self) -> ([f64; 2], f64) {
        let low = (self.v - self.half_angle).max(-FRAC_PI_2);
        let high = (self.v + self.half_angle).min(FRAC_PI_2);
        // The widest meridian that touches a circle round V: sin ΔH = sin r / cos V.
        let widest = self.half_angle.sin() / self.v.cos();
        let holds_pole = self.v.abs() + self.half_angle >= FRAC_PI_2;
        ([low, high], if holds_pole || widest >= 1.0 { PI } else { widest.asin() })
    }
}

/// Buckets along H and V: 2° each.
const BUCKETS: [usize; 2] = [180, 90];

/// Wider than rounding.
const MARGIN: f64 = 1e-9;

/// Round receivers. A direction may be in several of them.
#[derive(Clone, Debug, Default)]
pub struct Spots {
    /// Direction and 2 sin(½·half angle), squared: the farthest chord that is inside.
    circles: Vec<(DVec3, f64)>,
    /// Where the numbers of each bucket start.
    starts: Vec<u32>,
    numbers: Vec<u32>,
}

impl Spots {
    /// Receivers with a half angle above 0 and at most 90°.
    pub fn new(spots: &[Spot]) -> Self {
        if spots.is_empty() {
            return Self::default();
        }
        let mut buckets = vec![Vec::new(); BUCKETS[0] * BUCKETS[1]];
        for (number, spot) in spots.iter().enumerate() {
            let ([low, high], reach) = spot.extent();
            for row in row_of(low - MARGIN)..=row_of(high + MARGIN) {
                let reach = reach + MARGIN;
                let first = ((spot.h - reach) / TAU * BUCKETS[0] as f64).floor() as i64;
                let last = ((spot.h + reach) / TAU * BUCKETS[0] as f64).floor() as i64;
                for column in first..=last.min(first + BUCKETS[0] as i64 - 1) {
                    let column = column.rem_euclid(BUCKETS[0] as i64) as usize;
                    buckets[row * BUCKETS[0] + column].push(number as u32);
                }
            }
        }
        let circle = |spot: &Spot| {
            let chord = 2.0 * (0.5 * spot.half_angle).sin();
            (spot.direction(), chord * chord)
        };
        let mut starts = vec![0];
        for bucket in &buckets {
            starts.push(starts[starts.len() - 1] + bucket.len() as u32);
        }
        let circles = spots.iter().map(circle).collect();
        Self { circles, starts, numbers: buckets.concat() }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.circles.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.circles.is_empty()
    }

    /// The numbers of those with a unit `direction`, whose angles are `h` and `v`.
    pub fn around(&self, direction: DVec3, h: f64, v: f64) -> impl Iterator<Item = usize> + '_ {
        let column = ((h / TAU).rem_euclid(1.0) * BUCKETS[0] as f64) as usize;
        let bucket = row_of(v) * BUCKETS[0] + column.min(BUCKETS[0] - 1);
        let span = self.starts.get(bucket..bucket + 2).unwrap_or(&[0, 0]);
        let near = &self.numbers[span[0] as usize..span[1] as usize];
        near.iter().map(|number| *number as usize).filter(move |number| {
            let (middle, chord2) = self.circles[*number];
            middle.distance_squared(direction) <= chord2
        })
    }
}

fn row_of(v: f64) -> usize {
    let share = (v / PI + 0.5) * BUCKETS[1] as f64;
    (share.max(0.0) as usize).min(BUCKETS[1] - 1)
}
