// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Viewfinder`] and [`Snapshot`]: a picture in the making, for whoever watches it.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use super::rendering::Exposure;
use crate::film::Film;

/// The most samples that a pixel takes before the next pixel has its turn.
const LONGEST_PASS: u32 = 64;

/// While somebody watches, passes are to be so short that there is something new to see,
const WATCHED_PASS: Duration = Duration::from_millis(1500);

/// but not shorter than this: walks of one pixel meet the same triangles, and 1 sample in a pass
/// takes 1.21 times as long as 64, 4 take 1.12, 8 take 1.04 and 16 take 1.01 (p21w, one thread).
const SHORTEST_WATCHED: u32 = 16;

/// A picture as it stood between two passes.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// Pixels along a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Mean X, Y and Z of every pixel in cd/m², row by row from the upper left.
    pub xyz: Vec<f64>,
    /// Their standard errors, infinite below two samples.
    pub standard_error: Vec<f64>,
    /// How many samples there are, over all pixels.
    pub samples: u64,
    /// What is still to come, where that is known.
    pub outlook: Option<Outlook>,
}

/// How a picture will end whose samples are counted out.
#[derive(Clone, Debug)]
pub struct Outlook {
    /// The share of the work that is done, by the segments that a sample of each pixel takes.
    pub done: f64,
    /// What the standard error of every pixel's luminance will be multiplied with.
    pub shrinkage: Vec<f64>,
}

/// A part of a picture, and how many samples of it each pixel will have, where that is known.
pub(super) struct PartInMaking<'a> {
    pub film: &'a Film,
    pub at_end: Option<Box<dyn Fn(usize) -> u32 + 'a>>,
}

impl Snapshot {
    /// The picture so far, of which every pixel has `each` samples at the end, unless its exposure says
    /// how many.
    pub(super) fn so_far(exposures: &[Exposure], each: Option<u32>) -> Self {
        let eyes = exposures.iter().map(|Exposure { film, limit, .. }| {
            let counts = limit
                .as_ref()
                .map(|limit| Box::new(|at| limit.of(at)) as Box<dyn Fn(usize) -> u32>);
            let even = || each.map(|each| Box::new(move |_| each) as Box<dyn Fn(usize) -> u32>);
            PartInMaking { film, at_end: counts.or_else(even) }
        });
        Self::of(&eyes.collect::<Vec<_>>())
    }

    /// What the sum of `parts` shows now.
    fn of(parts: &[PartInMaking<'_>]) -> Self {
        let film = parts[0].film;
        let mut shown = Self { width: film.width, height: film.height, ..Self::default() };
        let is_counted = parts.iter().all(|part| part.at_end.is_some());
        let mut outlook = Outlook { done: 0.0, shrinkage: Vec::new() };
        let (mut done, mut all) = (0.0, 0.0);
        for at in 0..film.pixels.len() {
            let (mut xyz, mut variance, mut at_end) = ([0.0; 3], [0.0; 3], 0.0);
            for part in parts {
                let pixel = &part.film.pixels[at];
                let (mean, error) = (pixel.mean(), pixel.standard_error());
                let samples = part.at_end.as_ref().map_or(pixel.samples, |at_end| at_end(at));
                let share = f64::from(pixel.samples) / f64::from(samples.max(1));
                let segments = part.film.segments[at] as f64;
                xyz = [0, 1, 2].map(|i| xyz[i] + mean[i]);
                variance = [0, 1, 2].map(|i| variance[i] + error[i] * error[i]);
                at_end += error[1] * error[1] * share.min(1.0);
                done += segments;
                all += segments / share.clamp(f64::MIN_POSITIVE, 1.0);
                shown.samples += u64::from(pixel.samples);
            }
            shown.xyz.extend(xyz);
            shown.standard_error.extend(variance.map(f64::sqrt));
            let is_known = variance[1] > 0.0 && variance[1].is_finite();
            outlook.shrinkage.push(if is_known { (at_end / variance[1]).sqrt() } else { 1.0 });
        }
        outlook.done = if all > 0.0 { done / all } else { 0.0 };
        shown.outlook = is_counted.then_some(outlook);
        shown
    }
}

/// Hands snapshots from a rendering to its watcher, one for each time that one is asked for. No bit
/// of the result depends on it.
#[derive(Debug, Default)]
pub struct Viewfinder {
    /// Whether anybody ever looked.
    is_watched: AtomicBool,
    is_asked: AtomicBool,
    latest: Mutex<Option<Snapshot>>,
}

impl Viewfinder {
    /// Ask for a snapshot at the end of the pass that goes on.
    pub fn ask(&self) {
        self.is_watched.store(true, Ordering::Relaxed);
        self.is_asked.store(true, Ordering::Relaxed);
    }

    /// Take what was asked for, once it is there.
    pub fn take(&self) -> Option<Snapshot> {
        self.latest.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Show the picture if one is asked for; `snapshot` makes it.
    pub(super) fn show(&self, snapshot: impl FnOnce() -> Snapshot) {
        if self.is_asked.swap(false, Ordering::Relaxed) {
            let shown = snapshot();
            *self.latest.lock().unwrap_or_else(PoisonError::into_inner) = Some(shown);
        }
    }

    /// How many samples the next pass has after one of `length` that took so long.
    pub(super) fn next_length(&self, length: u32, took: Duration) -> u32 {
        let is_watched = self.is_watched.load(Ordering::Relaxed);
        let wanted = match took {
            took if !is_watched || took <= WATCHED_PASS / 2 => 2 * length,
            took if took <= WATCHED_PASS => length,
            _ => length / 2,
        };
        wanted.clamp(SHORTEST_WATCHED.min(2 * length), LONGEST_PASS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHORT: Duration = Duration::from_millis(100);
    const LONG: Duration = Duration::from_secs(2);

    #[test]
    fn nothing_is_shown_that_was_not_asked_for_and_each_asking_shows_once() {
        let finder = Viewfinder::default();
        finder.show(|| unreachable!("nobody asked"));
        assert!(finder.take().is_none());
        finder.ask();
        finder.show(|| Snapshot { samples: 3, ..Snapshot::default() });
        finder.show(|| unreachable!("it was shown"));
        assert_eq!(finder.take().map(|shown| shown.samples), Some(3));
        assert!(finder.take().is_none());
    }

    #[test]
    fn passes_grow_to_their_limit_and_are_short_only_while_somebody_watches() {
        let finder = Viewfinder::default();
        assert_eq!(finder.next_length(1, SHORT), 2);
        assert_eq!(finder.next_length(64, LONG), 64);
        finder.ask();
        assert_eq!(finder.next_length(16, SHORT), 32);
        assert_eq!(finder.next_length(64, SHORT), 64);
        assert_eq!(finder.next_length(16, Duration::from_secs(1)), 16);
        assert_eq!(finder.next_length(64, LONG), 32);
        // Fewer samples in a pass cost more than they show.
        assert_eq!(finder.next_length(16, LONG), 16);
        assert_eq!(finder.next_length(2, LONG), 4);
    }

    #[test]
    fn a_snapshot_has_the_means_and_errors_of_the_film() {
        let mut film = Film::new(2, 1, 0, 0);
        for value in [1.0, 3.0] {
            film.pixels[1].add([value, 2.0 * value, 0.0]);
        }
        let shown = Snapshot::of(&[PartInMaking { film: &film, at_end: None }]);
        assert_eq!((shown.width, shown.height, shown.samples), (2, 1, 2));
        assert_eq!(shown.xyz, [0.0, 0.0, 0.0, 2.0, 4.0, 0.0]);
        assert_eq!(shown.standard_error[..3], [f64::INFINITY; 3]);
        // Two samples at ±1 of their mean have the variance 2, and their mean half of it.
        assert_eq!(shown.standard_error[3..], [1.0, 2.0, 0.0]);
        assert!(shown.outlook.is_none());
    }

    /// A film of two pixels with the values 1 and 3, as often as said: the mean is 2.
    fn ones_and_threes(times: usize, segments: [u64; 2]) -> Film {
        let mut film = Film::new(2, 1, 0, 0);
        for pixel in &mut film.pixels {
            (0..times).for_each(|_| [1.0, 3.0].iter().for_each(|value| pixel.add([*value; 3])));
        }
        film.segments = segments.to_vec();
        film
    }

    #[test]
    fn the_outlook_counts_work_in_segments_and_errors_as_one_over_root_n() {
        let film = ones_and_threes(2, [8, 80]);
        // A sample of the second pixel takes ten times the work, and it gets four times as many.
        let at_end: Box<dyn Fn(usize) -> u32> = Box::new(|pixel| [4, 16][pixel]);
        let shown = Snapshot::of(&[PartInMaking { film: &film, at_end: Some(at_end) }]);
        let outlook = shown.outlook.unwrap();
        assert_eq!(outlook.shrinkage, [1.0, 0.5]);
        assert!((outlook.done - 88.0 / (8.0 + 320.0)).abs() < 1e-15);
    }

    #[test]
    fn parts_add_up_and_so_do_the_squares_of_their_errors() {
        let (one, other) = (ones_and_threes(1, [2, 2]), ones_and_threes(1, [2, 2]));
        let counts =
            |count: u32| -> Option<Box<dyn Fn(usize) -> u32>> { Some(Box::new(move |_| count)) };
        let shown = Snapshot::of(&[
            PartInMaking { film: &one, at_end: counts(2) },
            PartInMaking { film: &other, at_end: counts(8) },
        ]);
        assert_eq!(shown.xyz[..3], [4.0; 3]);
        assert!((shown.standard_error[0] - 2.0_f64.sqrt()).abs() < 1e-15);
        // Of 1 + 1 the second becomes a quarter.
        let outlook = shown.outlook.unwrap();
        assert!((outlook.shrinkage[0] - (1.25_f64 / 2.0).sqrt()).abs() < 1e-15);
        assert!((outlook.done - 8.0 / (4.0 + 16.0)).abs() < 1e-15);
    }
}
