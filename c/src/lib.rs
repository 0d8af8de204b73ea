//! The C interface: a controller, from its text to its controls. `c/include/fdcc.h` is its
//! description.
//!
//! No panic crosses the border: it becomes a status, and the controller refuses to go on. What is
//! asked of a null pointer is answered by nothing.

mod controller;

use controller::{Controller, Status};
use std::ffi::{CStr, c_char, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;
use std::slice;

/// What a text that C hands over says.
///
/// # Safety
///
/// The pointer is null or leads to bytes that end with 0.
// SAFETY: see above.
unsafe fn text<'t>(pointer: *const c_char) -> Option<&'t str> {
    if pointer.is_null() {
        return None;
    }
    // SAFETY: as the caller promises.
    unsafe { CStr::from_ptr(pointer) }.to_str().ok()
}

/// Does something with a controller; a panic ends its use.
///
/// # Safety
///
/// The pointer is null or from [`fdcc_new`], and nobody else uses it.
// SAFETY: see above.
unsafe fn with(controller: *mut Controller, work: impl FnOnce(&mut Controller) -> Status) -> c_int {
    // SAFETY: as the caller promises.
    let Some(controller) = (unsafe { controller.as_mut() }) else {
        return Status::WrongCall as c_int;
    };
    if controller.is_broken {
        return Status::Internal as c_int;
    }
    let done = catch_unwind(AssertUnwindSafe(|| work(controller)));
    let status = done.unwrap_or_else(|_| controller.broken());
    status as c_int
}

/// A controller for a model; null with a message if that is wrong.
///
/// # Safety
///
/// The model is null or ends with 0; the message is null or has room for `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fdcc_new(
    model: *const c_char,
    intervals: usize,
    message: *mut c_char,
    size: usize,
) -> *mut Controller {
    // SAFETY: as the caller promises.
    let text = unsafe { text(model) };
    let new = || text.ok_or("the model is no text in UTF-8".to_owned());
    let made = catch_unwind(|| new().and_then(|text| Controller::new(text, intervals)));
    match made.unwrap_or_else(|_| Err("a mistake of the library".into())) {
        Ok(controller) => Box::into_raw(Box::new(controller)),
        Err(why) => {
            if !message.is_null() && size > 0 {
                // SAFETY: as the caller promises.
                let room = unsafe { slice::from_raw_parts_mut(message.cast::<u8>(), size) };
                controller::fill(room, &why);
            }
            ptr::null_mut()
        }
    }
}

/// Gives a controller back.
///
/// # Safety
///
/// It is null or from [`fdcc_new`], and is not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fdcc_free(controller: *mut Controller) {
    if !controller.is_null() {
        // SAFETY: as the caller promises.
        let controller = unsafe { Box::from_raw(controller) };
        let _ = catch_unwind(AssertUnwindSafe(|| drop(controller)));
    }
}

/// Another value of a parameter.
///
/// # Safety
///
/// The controller is null or from [`fdcc_new`]; the name is null or ends with 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fdcc_set(
    controller: *mut Controller,
    parameter: *const c_char,
    value: f64,
) -> c_int {
    // SAFETY: as the caller promises.
    unsafe { with(controller, |it| it.set(text(parameter), value)) }
}

/// The values of a signal.
///
/// # Safety
///
/// The controller is null or from [`fdcc_new`]; the name is null or ends with 0; the values are
/// null, or so many.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fdcc_set_signal(
    controller: *mut Controller,
    signal: *const c_char,
    values: *const f64,
    count: usize,
) -> c_int {
    let set = |it: &mut Controller| {
        if values.is_null() {
            return it.wrong("`values` must not be null");
        }
        // SAFETY: as the caller promises.
        let (name, values) = unsafe { (text(signal), slice::from_raw_parts(values, count)) };
        it.set_signal(name, values)
    };
    // SAFETY: as the caller promises.
    unsafe { with(controller, set) }
}

/// The time of the signals that were not given.
///
/// # Safety
///
/// The controller is null or from [`fdcc_new`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fdcc_set_time(controller: *mut Controller, now: f64) -> c_int {
    // SAFETY: as the caller promises.
    unsafe { with(controller, |it| it.set_time(now)) }
}

/// The time for each step.
///
/// # Safety
///
/// The controller is null or from [`fdcc_new`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fdcc_set_budget(controller: *mut Controller, microseconds: u64) -> c_int {
    // SAFETY: as the caller promises.
    unsafe { with(controller, |it| it.set_budget(microseconds)) }
}

/// Solves from a state.
///
/// # Safety
///
/// The controller is null or from [`fdcc_new`]; `state` and `controls` are null, or have a number
/// for each state and each control.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fdcc_step(
    controller: *mut Controller,
    state: *const f64,
    controls: *mut f64,
) -> c_int {
    let step = |it: &mut Controller| {
        if state.is_null() || controls.is_null() {
            return it.wrong("`state` and `controls` must not be null");
        }
        // SAFETY: as the caller promises.
        let state = unsafe { slice::from_raw_parts(state, it.states.len()) };
        // SAFETY: as the caller promises.
        let controls = unsafe { slice::from_raw_parts_mut(controls, it.controls.len()) };
        it.step(state, controls)
    };
    // SAFETY: as the caller promises.
    unsafe { with(controller, step) }
}

/// Functions that ask a controller for something, and get `$none` where there is none.
macro_rules! asked {
    ($(
        $(#[$doc:meta])*
        $name:ident($it:ident $(, $at:ident)?) -> $result:ty, $none:expr, $value:expr;
    )*) => {$(
        $(#[$doc])*
        ///
        /// # Safety
        ///
        /// The controller is null or from [`fdcc_new`].
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(controller: *const Controller $(, $at: usize)?) -> $result {
            // SAFETY: as the caller promises.
            let controller = unsafe { controller.as_ref() };
            controller.and_then(|$it| $value).unwrap_or($none)
        }
    )*};
}

asked! {
    /// The number of states.
    fdcc_states(it) -> usize, 0, Some(it.states.len());
    /// The number of controls.
    fdcc_controls(it) -> usize, 0, Some(it.controls.len());
    /// The number of signals.
    fdcc_signals(it) -> usize, 0, Some(it.signals.len());
    /// The name of a state.
    fdcc_state_name(it, at) -> *const c_char, ptr::null(), it.states.get(at).map(|it| it.as_ptr());
    /// The name of a control.
    fdcc_control_name(it, at) -> *const c_char, ptr::null(),
        it.controls.get(at).map(|it| it.as_ptr());
    /// The name of a signal.
    fdcc_signal_name(it, at) -> *const c_char, ptr::null(),
        it.signals.get(at).map(|it| it.as_ptr());
    /// Why the last call was wrong.
    fdcc_message(it) -> *const c_char, c"".as_ptr(), Some(it.message.as_ptr());
    /// The objective.
    fdcc_objective(it) -> f64, 0.0, it.last().map(|it| it.objective());
    /// The largest violation of a constraint.
    fdcc_violation(it) -> f64, 0.0, it.last().map(|it| it.outcome.solution.constraint_violation);
    /// The iterations.
    fdcc_iterations(it) -> usize, 0, it.last().map(|it| it.outcome.solution.counts.iterations);
    /// The number of grid points.
    fdcc_points(it) -> usize, 0, it.last().map(|it| it.time().len());
    /// The grid points.
    fdcc_time(it) -> *const f64, ptr::null(), it.last().map(|it| it.time().as_ptr());
    /// A state at the grid points.
    fdcc_state(it, at) -> *const f64, ptr::null(), it.state(at).map(<[f64]>::as_ptr);
    /// A control on the intervals.
    fdcc_control(it, at) -> *const f64, ptr::null(), it.control(at).map(<[f64]>::as_ptr);
}
