//! Numbers of a result, lent to NumPy without a copy.

use pyo3::exceptions::PyBufferError;
use pyo3::ffi;
use pyo3::prelude::*;
use std::any::Any;
use std::ffi::c_int;
use std::sync::Arc;

/// 64-bit floats that belong to a result; `numpy.frombuffer` reads them where they are.
#[pyclass(frozen, module = "fdcc._fdcc")]
pub struct Column {
    numbers: &'static [f64],
    /// Whose they are.
    _owner: Arc<dyn Any + Send + Sync>,
}

impl Column {
    /// What `of` lends of an owner, if anything.
    pub fn lent<T: Any + Send + Sync>(
        owner: &Arc<T>,
        of: impl for<'o> FnOnce(&'o T) -> Option<&'o [f64]>,
    ) -> Option<Column> {
        let numbers: *const [f64] = of(owner)?;
        // SAFETY: the slice lives as long as the owner, which is kept beside it and, being shared,
        // is not changed.
        let numbers = unsafe { &*numbers };
        Some(Column { numbers, _owner: owner.clone() })
    }
}

#[pymethods]
impl Column {
    fn __len__(&self) -> usize {
        self.numbers.len()
    }

    /// Read-only bytes.
    // SAFETY: Python alone calls it, with a `view` that it owns and wants to be filled.
    unsafe fn __getbuffer__(
        slf: PyRef<'_, Self>,
        view: *mut ffi::Py_buffer,
        flags: c_int,
    ) -> PyResult<()> {
        if view.is_null() {
            return Err(PyBufferError::new_err("there is no view to fill"));
        }
        let (numbers, read_only) = (slf.numbers, 1);
        let start = numbers.as_ptr().cast_mut().cast();
        let length = size_of_val(numbers) as ffi::Py_ssize_t;
        // SAFETY: the view keeps this object and with it the numbers; nobody writes to them.
        let filled =
            unsafe { ffi::PyBuffer_FillInfo(view, slf.as_ptr(), start, length, read_only, flags) };
        if filled == 0 { Ok(()) } else { Err(PyErr::fetch(slf.py())) }
    }
}
