//! Functions of machine code, as Numba compiles them and as shared libraries have them: called without the interpreter.
#![allow(unsafe_code)]

use std::mem::transmute;
use std::sync::Arc;

use holonom::model::ExternalFunction;

use crate::function::Parts;

/// Most arguments of a function that takes them as numbers.
pub const MOST: usize = 8;

/// A function of machine code.
pub struct Native {
    call: Call,
    /// Keeps the code in memory.
    parts: Arc<Parts>,
}

/// How it is called.
enum Call {
    Of1(extern "C" fn(f64) -> f64),
    Of2(extern "C" fn(f64, f64) -> f64),
    Of3(extern "C" fn(f64, f64, f64) -> f64),
    Of4(extern "C" fn(f64, f64, f64, f64) -> f64),
    Of5(extern "C" fn(f64, f64, f64, f64, f64) -> f64),
    Of6(extern "C" fn(f64, f64, f64, f64, f64, f64) -> f64),
    Of7(extern "C" fn(f64, f64, f64, f64, f64, f64, f64) -> f64),
    Of8(extern "C" fn(f64, f64, f64, f64, f64, f64, f64, f64) -> f64),
    /// Reads its arguments from the first place and writes its values to the second.
    OfPointers(extern "C" fn(*const f64, *mut f64)),
}

impl Native {
    /// The function at an address: of numbers, of which there is one value, or of pointers to arguments and to values.
    ///
    /// What Python says of an address is taken at its word, as by `ctypes`: `holonom._functions` has it from the type of the function.
    pub fn new(address: usize, is_of_pointers: bool, parts: Arc<Parts>) -> Self {
        let code = address as *const ();
        // SAFETY: the type of the function that the address was taken of has said so, and its parts keep its code.
        let call = unsafe {
            match parts.arguments() {
                _ if is_of_pointers => Call::OfPointers(transmute::<*const (), extern "C" fn(*const f64, *mut f64)>(code)),
                1 => Call::Of1(transmute::<*const (), extern "C" fn(f64) -> f64>(code)),
                2 => Call::Of2(transmute::<*const (), extern "C" fn(f64, f64) -> f64>(code)),
                3 => Call::Of3(transmute::<*const (), extern "C" fn(f64, f64, f64) -> f64>(code)),
                4 => Call::Of4(transmute::<*const (), extern "C" fn(f64, f64, f64, f64) -> f64>(code)),
                5 => Call::Of5(transmute::<*const (), extern "C" fn(f64, f64, f64, f64, f64) -> f64>(code)),
                6 => Call::Of6(transmute::<*const (), extern "C" fn(f64, f64, f64, f64, f64, f64) -> f64>(code)),
                7 => Call::Of7(transmute::<*const (), extern "C" fn(f64, f64, f64, f64, f64, f64, f64) -> f64>(code)),
                8 => Call::Of8(transmute::<*const (), extern "C" fn(f64, f64, f64, f64, f64, f64, f64, f64) -> f64>(code)),
                _ => panic!("a function of numbers has at most {MOST}"),
            }
        };
        Self { call, parts }
    }
}

impl ExternalFunction for Native {
    fn arguments(&self) -> usize {
        self.parts.arguments()
    }

    fn values(&self) -> usize {
        self.parts.values
    }

    fn call(&self, a: &[f64], values: &mut [f64]) {
        values[0] = match self.call {
            Call::Of1(f) => f(a[0]),
            Call::Of2(f) => f(a[0], a[1]),
            Call::Of3(f) => f(a[0], a[1], a[2]),
            Call::Of4(f) => f(a[0], a[1], a[2], a[3]),
            Call::Of5(f) => f(a[0], a[1], a[2], a[3], a[4]),
            Call::Of6(f) => f(a[0], a[1], a[2], a[3], a[4], a[5]),
            Call::Of7(f) => f(a[0], a[1], a[2], a[3], a[4], a[5], a[6]),
            Call::Of8(f) => f(a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7]),
            Call::OfPointers(f) => return f(a.as_ptr(), values.as_mut_ptr()),
        };
    }
}
