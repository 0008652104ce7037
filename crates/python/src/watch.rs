// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`watch`]: work on threads of its own while Python watches and may interrupt.

use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::Ordering;
use std::sync::mpsc::{channel, RecvTimeoutError};
use std::time::Duration;

use lamplit_core::render::Progress;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;

use crate::preview::Preview;

/// How often Python is asked whether to go on.
const WATCH_INTERVAL: Duration = Duration::from_millis(50);

/// Work on another thread; ask Python every now and then whether to go on, and let it see `preview`.
/// Returns what the work brought, and whether a signal stopped it.
pub fn watch<T: Send>(
    py: Python<'_>,
    callback: Option<&Py<PyAny>>,
    mut preview: Preview<'_>,
    work: impl FnOnce(&Progress) -> T + Send,
) -> PyResult<(T, bool)> {
    let progress = Progress::default();
    let mut interrupted = false;
    let mut fault = None;
    let watched = &progress;
    let outcome = py.detach(|| {
        let (send, receive) = channel();
        std::thread::scope(|scope| {
            scope.spawn(move || {
                let result = catch_unwind(AssertUnwindSafe(|| work(watched)));
                // The receiver outlives this thread, so that sending cannot fail.
                let _ = send.send(result);
            });
            loop {
                match receive.recv_timeout(WATCH_INTERVAL) {
                    Ok(result) => return result.ok(),
                    Err(RecvTimeoutError::Disconnected) => return None,
                    Err(RecvTimeoutError::Timeout) if progress.is_cancelled() => {}
                    Err(RecvTimeoutError::Timeout) => {
                        let asked = Python::attach(|py| {
                            py.check_signals()?;
                            let done = progress.done.load(Ordering::Relaxed);
                            let total = progress.total.load(Ordering::Relaxed);
                            callback.map(|call| call.call1(py, (done, total))).transpose()?;
                            preview.look(py, &progress.viewfinder)
                        });
                        if let Err(error) = asked {
                            interrupted = Python::attach(|py| {
                                error.is_instance_of::<PyKeyboardInterrupt>(py)
                            });
                            fault = (!interrupted).then_some(error);
                            progress.cancelled.store(true, Ordering::Relaxed);
                        }
                    }
                }
            }
        })
    });
    match (outcome, fault) {
        (_, Some(fault)) => Err(fault),
        (Some(outcome), None) => Ok((outcome, interrupted)),
        (None, None) => Err(PyRuntimeError::new_err("the core stopped on a fault of its own")),
    }
}
