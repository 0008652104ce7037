// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Pixel filters, sampled in proportion to themselves, so that every sample has weight one.

use crate::math::DVec2;

/// How a pixel gathers light from round its centre. All are normalised and positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelFilter {
    /// Constant over the pixel: |x| ≤ ½.
    Box,
    /// 1 − |x| over |x| ≤ 1.
    Tent,
    /// exp(−x²/2σ²) with σ = ½ pixel, cut at 1.5 pixels (3σ).
    Gaussian,
}

impl PixelFilter {
    /// Return an offset from the pixel's centre, in pixels, for `u` uniform in the unit square.
    pub fn offset(self, u: DVec2) -> DVec2 {
        DVec2::new(self.inverse_distribution(u.x), self.inverse_distribution(u.y))
    }

    fn inverse_distribution(self, u: f64) -> f64 {
        match self {
            Self::Box => u - 0.5,
            Self::Tent if u < 0.5 => (2.0 * u).sqrt() - 1.0,
            Self::Tent => 1.0 - (2.0 * (1.0 - u)).sqrt(),
            Self::Gaussian => {
                const BELOW_MINUS_3_SIGMA: f64 = 1.349_898_031_630_094_6e-3;
                let inside = BELOW_MINUS_3_SIGMA + u * (1.0 - 2.0 * BELOW_MINUS_3_SIGMA);
                0.5 * normal_quantile(inside)
            }
        }
    }
}

/// The quantile of the standard normal distribution, to a relative error of 1.2e-9.
///
/// Source: P. J. Acklam, "An algorithm for computing the inverse normal cumulative distribution
/// function" (2003): rational approximations for the middle and the two tails.
fn normal_quantile(p: f64) -> f64 {
    const MIDDLE_TOP: [f64; 6] = [
        -3.969_683_028_665_376e1,
        2.209_460_984_245_205e2,
        -2.759_285_104_469_687e2,
        1.383_577_518_672_69e2,
        -3.066_479_806_614_716e1,
        2.506_628_277_459_239,
    ];
    const MIDDLE_BOTTOM: [f64; 6] = [
        -5.447_609_879_822_406e1,
        1.615_858_368_580_409e2,
        -1.556_989_798_598_866e2,
        6.680_131_188_771_972e1,
        -1.328_068_155_288_572e1,
        1.0,
    ];
    const TAIL_TOP: [f64; 6] = [
        -7.784_894_002_430_293e-3,
        -3.223_964_580_411_365e-1,
        -2.400_758_277_161_838,
        -2.549_732_539_343_734,
        4.374_664_141_464_968,
        2.938_163_982_698_783,
    ];
    const TAIL_BOTTOM: [f64; 5] = [
        7.784_695_709_041_462e-3,
        3.224_671_290_700_398e-1,
        2.445_134_137_142_996,
        3.754_408_661_907_416,
        1.0,
    ];
    const TAIL: f64 = 0.02425;
    let horner = |coefficients: &[f64], x: f64| coefficients.iter().fold(0.0, |s, c| s * x + c);
    if p > 1.0 - TAIL {
        return -normal_quantile(1.0 - p);
    }
    if p < TAIL {
        let q = (-2.0 * p.ln()).sqrt();
        return horner(&TAIL_TOP, q) / horner(&TAIL_BOTTOM, q);
    }
    let q = p - 0.5;
    let r = q * q;
    q * horner(&MIDDLE_TOP, r) / horner(&MIDDLE_BOTTOM, r)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(filter: PixelFilter) -> (f64, f64, f64) {
        const N: usize = 100_000;
        let xs = (0..N).map(|i| filter.inverse_distribution((i as f64 + 0.5) / N as f64));
        let (mut mean, mut square, mut reach) = (0.0, 0.0, 0.0f64);
        for x in xs {
            mean += x / N as f64;
            square += x * x / N as f64;
            reach = reach.max(x.abs());
        }
        (mean, square, reach)
    }

    #[test]
    fn each_filter_has_the_variance_and_reach_of_its_formula() {
        // Variances: box 1/12, tent 1/6, Gaussian cut at 3σ: σ²(1 − 2·3φ(3)/(Φ(3) − Φ(−3))).
        let cut_gaussian = 0.25 * (1.0 - 6.0 * 4.431_848_411_938e-3 / 0.997_300_203_936_740);
        for (filter, variance, half_width) in [
            (PixelFilter::Box, 1.0 / 12.0, 0.5),
            (PixelFilter::Tent, 1.0 / 6.0, 1.0),
            (PixelFilter::Gaussian, cut_gaussian, 1.5),
        ] {
            let (mean, square, reach) = moments(filter);
            assert!(mean.abs() < 1e-9, "{filter:?} is centred, mean {mean}");
            assert!((square - variance).abs() < 1e-5, "{filter:?} variance {square}");
            assert!(reach <= half_width && reach > 0.97 * half_width, "{filter:?} reach {reach}");
        }
    }

    #[test]
    fn the_normal_quantile_meets_printed_values() {
        // Abramowitz & Stegun, table 26.5 and the usual two-sided limits.
        for (p, x) in [(0.975, 1.959_963_985), (0.995, 2.575_829_304), (0.01, -2.326_347_874)] {
            assert!((normal_quantile(p) - x).abs() < 1e-8);
        }
    }
}
