// SPDX-License-Identifier: Apache-2.0 OR MIT
//! `Photometer`: light walked from its sources, and what receivers caught of it, as arrays.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use lamplit_core::film::{self, DirectionCells, GroupSums, PlaneMap, Spot, Spots, Xyz};
use lamplit_core::math::DMat3;
use lamplit_core::render;
use lamplit_core::spectrum::LANES;
use lamplit_core::transport::{Beam, Ledger, LightSource, RaySet, Shining, Tally};
use numpy::{PyArray2, PyArray3, PyArray4, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{direction, shaped, table, triples, vector, Spectrum, Triple};
use crate::outcome::lost_rays;
use crate::preview::Preview;
use crate::render::{PathMethod, Scene};
use crate::value_error;
use crate::watch::watch;

/// Where flux is caught. Angles are in rad, lengths in mm.
#[pyclass(frozen, module = "lamplit._core")]
pub struct Receivers(film::Receivers);

/// A plane's middle, half of its width and of its height as vectors, columns and rows.
type MapTuple = (Triple, Triple, Triple, [usize; 2]);

#[pymethods]
impl Receivers {
    /// `spots` (n, 3) are H, V and half of the angle of round receivers; `cell_edges` the borders of
    /// an H–V grid; `map` a plane's middle, half its width and height, columns and rows.
    #[new]
    #[pyo3(signature = (
        axis, up, centre_mm, *, distance_mm=None, spots=None, cell_edges=None, map=None,
        spot_bands=0, cell_bands=0
    ))]
    fn new(
        axis: Triple,
        up: Triple,
        centre_mm: Triple,
        distance_mm: Option<f64>,
        spots: Option<PyReadonlyArray2<'_, f64>>,
        cell_edges: Option<(PyReadonlyArray1<'_, f64>, PyReadonlyArray1<'_, f64>)>,
        map: Option<MapTuple>,
        spot_bands: usize,
        cell_bands: usize,
    ) -> PyResult<Self> {
        let axis = direction(axis)?;
        let along = vector(up).cross(axis).try_normalize();
        let right = along.ok_or_else(|| value_error("up must not be parallel to the axis"))?;
        let spots = spots.as_ref().map(|array| triples(array)).transpose()?.unwrap_or_default();
        let spots: Vec<Spot> =
            spots.iter().map(|&[h, v, half_angle]| Spot { h, v, half_angle }).collect();
        let cells = cell_edges.map(|(h, v)| {
            let cells = DirectionCells::new(h.as_array().to_vec(), v.as_array().to_vec());
            cells.ok_or_else(|| value_error("the borders of a grid's cells must rise"))
        });
        let map = map.map(|(centre, half_width, half_height, size)| PlaneMap {
            centre: vector(centre),
            half_width: vector(half_width),
            half_height: vector(half_height),
            size,
        });
        Ok(Self(film::Receivers {
            frame: DMat3::from_cols(right, axis.cross(right), axis),
            centre: vector(centre_mm),
            distance: distance_mm,
            cells: cells.transpose()?,
            spots: Spots::new(&spots),
            map,
            spot_bands,
            cell_bands,
        }))
    }
}

/// Light given as rays.
#[pyclass(frozen, module = "lamplit._core")]
pub struct Rays(Arc<RaySet>);

#[pymethods]
impl Rays {
    /// With one `spectrum`, fluxes in lm; with the numbers of the rays' own `wavelengths` among those
    /// of the scene's pictures, `step_nm` apart, fluxes in W.
    #[new]
    #[pyo3(signature = (
        scene, positions_mm, directions, fluxes, *, spectrum=None, wavelengths=None, step_nm=1.0,
        group=0
    ))]
    fn new(
        scene: &Scene,
        positions_mm: PyReadonlyArray2<'_, f64>,
        directions: PyReadonlyArray2<'_, f64>,
        fluxes: PyReadonlyArray1<'_, f64>,
        spectrum: Option<Spectrum<'_>>,
        wavelengths: Option<PyReadonlyArray1<'_, u32>>,
        step_nm: f64,
        group: usize,
    ) -> PyResult<Self> {
        let (positions, ways) = (triples(&positions_mm)?, triples(&directions)?);
        let fluxes = fluxes.as_array().to_vec();
        let luminosity = &scene.world().colour_matching[1];
        let set = match (spectrum, wavelengths) {
            (Some(spectrum), None) => {
                let spectrum = table(&spectrum)?;
                RaySet::of_one_spectrum(&positions, &ways, fluxes, &spectrum, luminosity)
            }
            (None, Some(own)) => {
                let own = (own.as_array().to_vec(), step_nm);
                RaySet::of_wavelengths(&positions, &ways, fluxes, own, luminosity)
            }
            _ => return Err(value_error("rays have one spectrum, or wavelengths of their own")),
        };
        Ok(Self(Arc::new(set.map_err(value_error)?.in_group(group))))
    }
}

/// Light walked from its sources, in batches. All numbers are fluxes per path: X, Y, Z with Y in lm,
/// bands in W/nm.
#[pyclass(frozen, module = "lamplit._core")]
pub struct Photometer {
    scene: Py<Scene>,
    meter: Mutex<render::Photometer>,
}

impl Photometer {
    fn of(
        scene: Py<Scene>,
        source: LightSource,
        receivers: &Receivers,
        method: &PathMethod,
        seed: u64,
    ) -> PyResult<Self> {
        let world = scene.get().world();
        let meter = render::Photometer::new(&world, source, receivers.0.clone(), method.0, seed);
        drop(world);
        let meter = Mutex::new(meter.map_err(value_error)?);
        Ok(Self { scene, meter })
    }

    fn meter(&self) -> MutexGuard<'_, render::Photometer> {
        self.meter.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// (batches, groups, receivers, 3), per path.
    fn tristimulus<'py>(
        &self,
        py: Python<'py>,
        of: impl Fn(&GroupSums) -> &[Xyz],
    ) -> PyResult<Bound<'py, PyArray4<f64>>> {
        let meter = self.meter();
        let batches = meter.batches();
        let (groups, count) = (batches[0].groups.len(), of(&batches[0].groups[0]).len());
        let mut values = Vec::with_capacity(batches.len() * groups * count * 3);
        for batch in batches {
            let share = 1.0 / f64::from(batch.paths.max(1));
            let sums = batch.groups.iter().flat_map(&of).flat_map(|xyz| xyz.0);
            values.extend(sums.map(|sum| sum * share));
        }
        shaped(py, values, [batches.len(), groups, count, 3])
    }

    /// (batches, groups, receivers, bands) of what has the bands of spots, per path.
    fn bands_by_batch<'py>(
        &self,
        py: Python<'py>,
        of: impl Fn(&GroupSums) -> &[f64],
    ) -> PyResult<Bound<'py, PyArray4<f64>>> {
        let meter = self.meter();
        let per_lane = meter.receivers().spot_bands;
        let batches = meter.batches();
        let (groups, count) = (batches[0].groups.len(), of(&batches[0].groups[0]).len());
        let mut values = Vec::with_capacity(batches.len() * groups * count);
        for batch in batches {
            // Each part of a lane has its share of the phases, and so of the paths.
            let share = per_lane as f64 / f64::from(batch.paths.max(1));
            values.extend(batch.groups.iter().flat_map(&of).map(|sum| sum * share));
        }
        let bands = per_lane * LANES;
        let receivers = count.checked_div(bands).unwrap_or(0);
        shaped(py, values, [batches.len(), groups, receivers, bands])
    }

    /// (groups, receivers, bands) of the grid's cells, per path and over all batches.
    fn bands<'py>(
        &self,
        py: Python<'py>,
        of: impl Fn(&GroupSums) -> &[f64],
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let meter = self.meter();
        let per_lane = meter.receivers().cell_bands;
        let batches = meter.batches();
        let bands = per_lane * LANES;
        let paths: f64 = batches.iter().map(|batch| f64::from(batch.paths)).sum();
        // Each part of a lane has its share of the phases, and so of the paths.
        let share = per_lane as f64 / paths.max(1.0);
        let groups = batches[0].groups.len();
        let mut values = Vec::new();
        for group in 0..groups {
            let mut sums = vec![0.0; of(&batches[0].groups[group]).len()];
            for batch in batches {
                for (sum, value) in sums.iter_mut().zip(of(&batch.groups[group])) {
                    *sum += value * share;
                }
            }
            values.extend(sums);
        }
        let receivers = values.len().checked_div(groups * bands).unwrap_or(0);
        shaped(py, values, [groups, receivers, bands])
    }
}

#[pymethods]
impl Photometer {
    /// For the light of all bodies that shine, and of `rays`.
    #[staticmethod]
    #[pyo3(signature = (scene, receivers, method, *, rays=Vec::new(), seed=1))]
    fn shining(
        py: Python<'_>,
        scene: Py<Scene>,
        receivers: &Receivers,
        method: &PathMethod,
        rays: Vec<PyRef<'_, Rays>>,
        seed: u64,
    ) -> PyResult<Self> {
        let shining = py.detach(|| Shining::of(&scene.get().world()));
        let mut parts = vec![LightSource::Shining(shining)];
        parts.extend(rays.iter().map(|rays| LightSource::Rays(rays.0.clone())));
        let source = LightSource::several(&scene.get().world(), parts).map_err(value_error)?;
        Self::of(scene, source, receivers, method, seed)
    }

    /// For given rays alone; all are counted to one light group.
    #[staticmethod]
    #[pyo3(signature = (scene, receivers, method, rays, *, seed=1))]
    fn rays(
        scene: Py<Scene>,
        receivers: &Receivers,
        method: &PathMethod,
        rays: &Rays,
        seed: u64,
    ) -> PyResult<Self> {
        Self::of(scene, LightSource::Rays(rays.0.clone()), receivers, method, seed)
    }

    /// For a beam along `travels`, from a disc of an angular radius in rad, that gives a face square
    /// to it the spectral `irradiance` in W/(m² nm).
    #[staticmethod]
    #[pyo3(signature = (
        scene, receivers, method, travels, angular_radius_rad, irradiance, *, seed=1
    ))]
    fn beam(
        scene: Py<Scene>,
        receivers: &Receivers,
        method: &PathMethod,
        travels: Triple,
        angular_radius_rad: f64,
        irradiance: Spectrum<'_>,
        seed: u64,
    ) -> PyResult<Self> {
        let beam = Beam::new(
            &scene.get().world(),
            vector(travels),
            angular_radius_rad,
            table(&irradiance)?,
        );
        let source = LightSource::Beam(beam.map_err(value_error)?);
        Self::of(scene, source, receivers, method, seed)
    }

    /// Walk `more` paths of every batch, or until the time is up, and return whether a signal
    /// stopped it. `progress(done, total)` is called a few times a second with counts of paths.
    #[pyo3(signature = (more, *, time_budget_s=None, threads=0, progress=None))]
    fn walk(
        &self,
        py: Python<'_>,
        more: u32,
        time_budget_s: Option<f64>,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<bool> {
        let time_budget = time_budget_s.map(Duration::try_from_secs_f64).transpose();
        let time_budget = time_budget.map_err(value_error)?;
        let (outcome, interrupted) =
            watch(py, progress.as_ref(), Preview::new(None), |progress| {
                self.meter().walk(&self.scene.get().world(), more, time_budget, threads, progress)
            })?;
        outcome.map_err(value_error)?;
        Ok(interrupted)
    }

    /// How many paths each batch has walked.
    #[getter]
    fn paths_per_batch(&self) -> u32 {
        self.meter().paths_per_batch()
    }

    /// X, Y, Z of the flux that each light group sends out, (groups, 3).
    fn emitted<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let flux = self.meter().source().flux(&self.scene.get().world());
        let groups = flux.len();
        shaped(py, flux.into_iter().flatten().collect(), [groups, 3])
    }

    /// All flux that leaves the scene, (batches, groups, 1, 3).
    fn out<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray4<f64>>> {
        self.tristimulus(py, |sums| std::slice::from_ref(&sums.out))
    }

    /// The flux into each spot, (batches, groups, spots, 3).
    fn spots<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray4<f64>>> {
        self.tristimulus(py, |sums| &sums.spots)
    }

    /// The flux into each cell of the grid, along H first, (batches, groups, cells, 3).
    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray4<f64>>> {
        self.tristimulus(py, |sums| &sums.cells)
    }

    /// The flux into each pixel of the map, from its upper left, (batches, groups, pixels, 3).
    fn map<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray4<f64>>> {
        self.tristimulus(py, |sums| &sums.map)
    }

    /// The spectral flux that leaves the scene, (batches, groups, 1, bands).
    fn out_bands<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray4<f64>>> {
        self.bands_by_batch(py, |sums| &sums.out_bands)
    }

    /// The spectral flux into each spot, (batches, groups, spots, bands).
    fn spot_bands<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray4<f64>>> {
        self.bands_by_batch(py, |sums| &sums.spot_bands)
    }

    /// The spectral flux into each cell of the grid, over all batches, (groups, cells, bands).
    fn cell_bands<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        self.bands(py, |sums| &sums.cell_bands)
    }

    /// Where the luminous flux of a light group went, in lm, or None where nothing was walked:
    /// `emitted`, `out`, `cut_by_depth`, `lost`, `chance`, `gap`, and `absorbed` by body.
    fn ledger<'py>(&self, py: Python<'py>, group: usize) -> PyResult<Option<Bound<'py, PyDict>>> {
        let meter = self.meter();
        let world = self.scene.get().world();
        let mut ledger = Ledger::new(world.bodies.len());
        let mut paths = 0.0;
        for batch in meter.batches() {
            ledger.add(&batch.ledgers[group]);
            paths += f64::from(batch.paths);
        }
        let Some(balance) = ledger.balance() else {
            return Ok(None);
        };
        let all: f64 = meter.source().flux(&world).iter().map(|xyz| xyz[1]).sum();
        let emitted = ledger.started() / paths * all;
        let absorbed = PyDict::new(py);
        for (body, share) in world.bodies.iter().zip(&balance.absorbed) {
            absorbed.set_item(&body.name, share * emitted)?;
        }
        let entries = PyDict::new(py);
        entries.set_item("emitted", emitted)?;
        entries.set_item("out", balance.escaped * emitted)?;
        entries.set_item("absorbed", absorbed)?;
        entries.set_item("cut_by_depth", balance.cut_by_depth * emitted)?;
        entries.set_item("lost", balance.lost * emitted)?;
        entries.set_item("chance", balance.chance * emitted)?;
        entries.set_item("gap", balance.gap() * emitted)?;
        Ok(Some(entries))
    }

    /// Counts of rays, of branches cut by depth, of dropped paths, and lost rays by body and cause.
    fn statistics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let scene = self.scene.get().world();
        let mut tally = Tally::new(scene.bodies.len());
        self.meter().batches().iter().for_each(|batch| tally.add(&batch.tally));
        let names: Vec<String> = scene.bodies.iter().map(|body| body.name.clone()).collect();
        let statistics = PyDict::new(py);
        statistics.set_item("rays", tally.segments())?;
        statistics.set_item("cut_by_depth", tally.cut_by_depth)?;
        statistics.set_item("dropped_paths", tally.dropped_samples)?;
        if let Some((batch, path)) = tally.first_dropped {
            statistics.set_item("first_dropped_path", (batch, path))?;
        }
        statistics.set_item("lost_rays", lost_rays(py, &tally, &names)?)?;
        Ok(statistics)
    }
}
