// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Preview`]: shows Python the picture in the making, now and then.

use std::time::{Duration, Instant};

use lamplit_core::render::{Snapshot, Viewfinder};
use pyo3::prelude::*;

use crate::arrays::shaped;

/// A new look is due after this time at the earliest.
const INTERVAL: Duration = Duration::from_secs(2);

/// What Python does with a look takes a core from the rendering: it may have one part in so many.
const PARTS: u32 = 10;

/// Calls `callback(xyz, standard_error, samples, outlook)` at most every [`INTERVAL`].
pub struct Preview<'a> {
    callback: Option<&'a Py<PyAny>>,
    due: Instant,
}

impl<'a> Preview<'a> {
    /// The first look is due at once.
    pub fn new(callback: Option<&'a Py<PyAny>>) -> Self {
        Self { callback, due: Instant::now() }
    }

    /// Ask for a look when it is due, and show Python what has come.
    pub fn look(&mut self, py: Python<'_>, finder: &Viewfinder) -> PyResult<()> {
        let Some(callback) = self.callback else {
            return Ok(());
        };
        let began = Instant::now();
        if let Some(snapshot) = finder.take() {
            show(py, callback, snapshot)?;
            self.due = Instant::now() + INTERVAL.max(PARTS * began.elapsed());
        } else if began >= self.due {
            finder.ask();
        }
        Ok(())
    }
}

fn show(py: Python<'_>, callback: &Py<PyAny>, snapshot: Snapshot) -> PyResult<()> {
    let shape = [snapshot.height as usize, snapshot.width as usize, 3];
    let xyz = shaped(py, snapshot.xyz, shape)?;
    let standard_error = shaped(py, snapshot.standard_error, shape)?;
    let outlook = snapshot.outlook.map(|outlook| {
        let shrinkage = shaped(py, outlook.shrinkage, [shape[0], shape[1]])?;
        PyResult::Ok((outlook.done, shrinkage))
    });
    callback.call1(py, (xyz, standard_error, snapshot.samples, outlook.transpose()?))?;
    Ok(())
}
