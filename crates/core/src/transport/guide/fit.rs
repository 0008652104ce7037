// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Lobes from light that was seen to arrive.

use super::lobe::{Lobe, Origin};
use super::Arrival;
use crate::math::DVec3;

/// How many arrivals one lobe stands for, at least, on average.
const ARRIVALS_PER_LOBE: usize = 10;
/// The most lobes of a region.
pub(super) const MOST_LOBES: usize = 24;
/// Rounds of Lloyd's algorithm, and of the fit of a spread.
const ROUNDS: usize = 6;
/// The narrowest lobe's s².
const NARROWEST: f64 = 1e-6;

/// Lobes with their shares of the light that arrives in one region.
///
/// Arrivals are sorted by the place that their light seems to come from, as it is seen from the
/// middle of the region (k-means, begun with those that lie farthest apart). Each group becomes a lobe
/// from a point or from far away, whichever fits better. Its spread is the likeliest for the angles
/// between what the lobe says and what was seen.
///
/// Source: S. Lloyd, "Least squares quantization in PCM", IEEE Trans. Inf. Theory 28(2), 1982; the idea
/// that a lobe has a distance is L. Ruppert et al., "Robust Fitting of Parallax-Aware Mixtures for
/// Path Guiding", ACM TOG 39(4), 2020.
pub(super) fn lobes(arrivals: &[Arrival]) -> Vec<(Lobe, f64)> {
    let count = (arrivals.len() / ARRIVALS_PER_LOBE).clamp(1, MOST_LOBES);
    let middle = arrivals.iter().map(|arrival| arrival.position).sum::<DVec3>();
    let middle = middle / arrivals.len() as f64;
    let seen: Vec<DVec3> =
        arrivals.iter().map(|arrival| Origin::Point(arrival.origin()).from(middle)).collect();
    let group = groups(&seen, arrivals, count);
    let total: f64 = arrivals.iter().map(|arrival| arrival.weight).sum();
    let lobe = |number: usize| {
        let members = arrivals.iter().zip(&group).filter(|(_, group)| **group == number);
        let own: Vec<&Arrival> = members.map(|(arrival, _)| arrival).collect();
        let weight: f64 = own.iter().map(|arrival| arrival.weight).sum();
        (weight > 0.0).then(|| (fit(&own, weight, middle), weight / total))
    };
    (0..count).filter_map(lobe).collect()
}

/// The number of each arrival's group.
fn groups(seen: &[DVec3], arrivals: &[Arrival], count: usize) -> Vec<usize> {
    let mut means = vec![seen[0]];
    let mut nearest: Vec<f64> = seen.iter().map(|at| at.distance_squared(means[0])).collect();
    while means.len() < count {
        let far = |at: &usize| nearest[*at] * arrivals[*at].weight;
        let next = (0..seen.len()).max_by(|a, b| far(a).total_cmp(&far(b)));
        let Some(next) = next else { break };
        means.push(seen[next]);
        for (nearest, at) in nearest.iter_mut().zip(seen) {
            *nearest = nearest.min(at.distance_squared(seen[next]));
        }
    }
    let mut group = vec![0; seen.len()];
    for _ in 0..ROUNDS {
        let mut sums = vec![(DVec3::ZERO, 0.0); means.len()];
        for ((group, at), arrival) in group.iter_mut().zip(seen).zip(arrivals) {
            let distance = |mean: usize| at.distance_squared(means[mean]);
            *group =
                (0..means.len()).min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(0);
            sums[*group].0 += *at * arrival.weight;
            sums[*group].1 += arrival.weight;
        }
        for (mean, (sum, weight)) in means.iter_mut().zip(sums) {
            if weight > 0.0 {
                *mean = sum / weight;
            }
        }
    }
    group
}

/// The lobe of one group.
fn fit(own: &[&Arrival], weight: f64, middle: DVec3) -> Lobe {
    let mean = |value: &dyn Fn(&Arrival) -> DVec3| {
        own.iter().map(|arrival| value(arrival) * arrival.weight).sum::<DVec3>() / weight
    };
    let far = Origin::Far(mean(&|arrival| arrival.direction).try_normalize().unwrap_or(DVec3::Z));
    let point = Origin::Point(mean(&Arrival::origin));
    let reach = own.iter().map(|arrival| arrival.position.distance(middle)).fold(0.0, f64::max);
    let [point, far] = [point, far].map(|origin| {
        let distance = own.iter().map(|arrival| arrival.way).sum::<f64>() / own.len() as f64;
        Lobe { origin, spread2: spread2(own, origin, reach / distance.max(1e-9)) }
    });
    if point.spread2 < far.spread2 {
        point
    } else {
        far
    }
}

/// The likeliest s² for the angles between `origin` and the arrivals' directions, with one more
/// arrival at `doubt`, for what so few cannot tell.
///
/// Setting the derivative of Σ w ln(s²/(s² + r²)²) to zero gives Σ w (s² − r²)/(s² + r²) = 0.
fn spread2(own: &[&Arrival], origin: Origin, doubt: f64) -> f64 {
    let mean_weight = own.iter().map(|arrival| arrival.weight).sum::<f64>() / own.len() as f64;
    let angles: Vec<(f64, f64)> = own
        .iter()
        .map(|arrival| {
            let axis = origin.from(arrival.position);
            let cos = axis.dot(arrival.direction).max(1e-3);
            let r2 = axis.cross(arrival.direction).length_squared() / (cos * cos);
            (arrival.weight, r2)
        })
        .chain([(mean_weight, doubt * doubt)])
        .collect();
    let weights: f64 = angles.iter().map(|(weight, _)| weight).sum();
    let mut s2 = angles.iter().map(|(weight, r2)| weight * r2).sum::<f64>() / weights;
    for _ in 0..2 * ROUNDS {
        let (mut over, mut under) = (0.0, 0.0);
        for (weight, r2) in &angles {
            let share = weight / (s2 + r2).max(f64::MIN_POSITIVE);
            over += share * r2;
            under += share * s2;
        }
        s2 *= over / under.max(f64::MIN_POSITIVE);
    }
    s2.clamp(NARROWEST, 1e3)
}
