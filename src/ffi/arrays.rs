//! Arrays, texts and structs of the caller, in and out. Every size is checked before anything is reserved or read.

use super::basics::*;
use super::guard::{Failure, Outcome};
use crate::pipeline::places::Place;
use core::ffi::{CStr, c_char};
use glam::{Vec3, Vec4};
use std::fmt::Display;

/// Structs larger than this are none of the library's, but uninitialised memory.
const LARGEST_STRUCT: usize = 1 << 16;

/// Types that any bytes make: numbers and what consists of them without gaps that matter.
///
/// # Safety
/// Any bytes are a value of the type.
pub unsafe trait Plain: Copy {}
macro_rules! plain { ($($name:ty),*) => { $(unsafe impl Plain for $name {})* } }
plain!(
    u8, u16, u32, i32, f32, f64, [f32; 2], [f32; 3], [f32; 4], [f64; 3], [f64; 9], [f64; 16], [u32; 3], Vec3,
    Vec4
);

/// An empty array that can hold `count` elements.
pub fn reserved<T>(count: usize, what: impl Display) -> Outcome<Vec<T>> {
    let mut array = Vec::new();
    array.try_reserve_exact(count).map_err(|_| {
        Failure::new(
            SDEF_STATUS_OUT_OF_MEMORY,
            format!("there is no memory for {count} {what}: give less, or free some"),
        )
    })?;
    Ok(array)
}

/// Checks an array of `count` elements of `size` bytes that begin `stride` bytes apart, and gives the stride.
pub fn stride_of(
    what: &impl Display,
    is_null: bool,
    count: usize,
    stride: usize,
    size: usize,
) -> Outcome<usize> {
    if count > 0 && is_null {
        return Err(Failure::argument(format!("{what} is NULL, but {count} are needed: give the array")));
    }
    let stride = if stride == 0 { size } else { stride };
    if stride < size {
        return Err(Failure::argument(format!(
            "the stride of {what} is {stride} bytes, but one takes {size}: give 0 or at least that"
        )));
    }
    match count.checked_mul(stride) {
        Some(bytes) if isize::try_from(bytes).is_ok() => Ok(stride),
        _ => Err(Failure::argument(format!(
            "{what}: {count} with a stride of {stride} bytes are more than memory can hold: give fewer"
        ))),
    }
}

/// An array of the caller's, checked and not yet copied.
#[derive(Clone, Copy)]
pub struct Input<T> {
    start: *const u8,
    count: usize,
    stride: usize,
    element: std::marker::PhantomData<T>,
}

impl<T: Plain> Input<T> {
    /// Checks pointer, count and stride.
    ///
    /// # Safety
    /// `start` is NULL or holds as much as `count` and `stride` say, for as long as this is used.
    pub unsafe fn new(what: impl Display, start: *const T, count: usize, stride: usize) -> Outcome<Self> {
        let stride = stride_of(&what, start.is_null(), count, stride, size_of::<T>())?;
        Ok(Self { start: start.cast(), count, stride, element: std::marker::PhantomData })
    }

    /// How many elements there are.
    pub fn len(&self) -> usize {
        self.count
    }

    pub fn get(&self, index: usize) -> T {
        debug_assert!(index < self.count);
        // SAFETY: within what the caller said that the array holds; any bytes are a value.
        unsafe { self.start.add(index * self.stride).cast::<T>().read_unaligned() }
    }

    pub fn iter(&self) -> impl Iterator<Item = T> + '_ {
        (0..self.count).map(|index| self.get(index))
    }

    /// Copies everything.
    pub fn to_vec(self, what: impl Display) -> Outcome<Vec<T>> {
        let mut array = reserved(self.count, what)?;
        if self.count == 0 {
            return Ok(array);
        }
        if self.stride == size_of::<T>() {
            // SAFETY: as many bytes are reserved, and the caller's array holds as many.
            unsafe {
                let to: *mut T = array.as_mut_ptr();
                to.cast::<u8>().copy_from_nonoverlapping(self.start, self.count * self.stride);
                array.set_len(self.count);
            }
        } else {
            array.extend(self.iter());
        }
        Ok(array)
    }
}

/// Reads vectors; NULL where they may be left out.
///
/// # Safety
/// As [`Input::new`].
pub unsafe fn optional<T: Plain>(
    what: impl Display,
    start: *const f32,
    count: usize,
    stride: usize,
) -> Outcome<Vec<T>> {
    if start.is_null() {
        return Ok(Vec::new());
    }
    unsafe { Input::<T>::new(&what, start.cast(), count, stride) }?.to_vec(what)
}

/// A text of the caller's; what is no UTF-8 is replaced, for names of old files come in any encoding.
///
/// # Safety
/// `text` is NULL or ends with a NUL.
pub unsafe fn text(text: *const c_char) -> String {
    if text.is_null() {
        return String::new();
    }
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}

/// A text that must be there.
///
/// # Safety
/// As [`text`].
pub unsafe fn needed_text(what: impl Display, from: *const c_char) -> Outcome<String> {
    let text = unsafe { text(from) };
    if text.is_empty() {
        let is = if from.is_null() { "NULL" } else { "empty" };
        return Err(Failure::argument(format!("{what} is {is}: give a name")));
    }
    Ok(text)
}

/// A struct of the caller's that begins with its size, `struct_size`.
///
/// # Safety
/// As [`Plain`]; the first field is `struct_size: u32`.
pub unsafe trait HostStruct: Plain {
    /// Its name in C.
    const NAME: &'static str;
    /// Its size in version 1 of the ABI, which no host falls below: for a struct that has grown since, `offset_of!` of the
    /// first field that came later.
    const FIRST_SIZE: usize = size_of::<Self>();

    /// What the fields are that a host's older struct does not have.
    fn defaults() -> Self {
        // SAFETY: any bytes are a value.
        unsafe { core::mem::zeroed() }
    }

    /// Of the fields that must be 0 in a struct that is read, so that they can get a meaning later, the first that is not.
    fn reserved(&self) -> Option<u32> {
        None
    }
}

/// Words of 4 bytes in fields that are not set: 0, and the halves of NAN as a float or a double.
const UNSET: [u32; 5] = [0, 0x7fc0_0000, 0xffc0_0000, 0x7ff8_0000, 0xfff8_0000];

/// Structs of the caller, the fields of each that must be 0, and its defaults where it is not all zero by default.
macro_rules! host_structs { ($($name:ident $(($($reserved:ident),+))? $(= $defaults:expr)?),*) => { $(
    // SAFETY: `#[repr(C)]`, numbers and pointers alone, `struct_size` first.
    unsafe impl $crate::ffi::arrays::Plain for $name {}
    unsafe impl $crate::ffi::arrays::HostStruct for $name {
        const NAME: &'static str = stringify!($name);
        $(
            fn defaults() -> Self {
                $defaults
            }
        )?
        $(
            fn reserved(&self) -> Option<u32> {
                [$(self.$reserved),+].into_iter().find(|number| *number != 0)
            }
        )?
    }
)* } }
pub(super) use host_structs;

/// Checks the size that a caller's struct says.
pub fn check_size<T: HostStruct>(size: u32) -> Outcome<usize> {
    let bytes = size as usize;
    if !(T::FIRST_SIZE..=LARGEST_STRUCT).contains(&bytes) || !bytes.is_multiple_of(4) {
        let (name, first, own) = (T::NAME, T::FIRST_SIZE, size_of::<T>());
        return Err(Failure::argument(format!(
            "struct_size of {name} is {size}: set it to sizeof({name}), {own} in this library's header, {first} at least"
        )));
    }
    Ok(bytes)
}

/// A copy of the caller's struct, which may be older (shorter) or newer (longer) than ours, over the defaults.
///
/// What a newer one has beyond ours must not be set: its field would do nothing.
///
/// # Safety
/// `from` is NULL or points to as many bytes as its first number says.
pub unsafe fn struct_in<T: HostStruct>(from: *const T) -> Outcome<T> {
    if from.is_null() {
        return Err(Failure::argument(format!("{} is NULL: give one", T::NAME)));
    }
    unsafe {
        let size = check_size::<T>(from.cast::<u32>().read_unaligned())?;
        let own = size_of::<T>();
        let is_set = |at: usize| !UNSET.contains(&from.cast::<u8>().add(at).cast::<u32>().read_unaligned());
        if let Some(at) = (own..size).step_by(4).find(|&at| is_set(at)) {
            return Err(Failure::argument(format!(
                "{} has a field set at byte {at}, but this library, version {}, knows {own} bytes of it: take the library of your header's release",
                T::NAME,
                env!("CARGO_PKG_VERSION")
            )));
        }
        let mut copy = T::defaults();
        (&raw mut copy).cast::<u8>().copy_from_nonoverlapping(from.cast(), size.min(own));
        if let Some(number) = copy.reserved() {
            return Err(Failure::argument(format!(
                "a reserved field of {} is {number}: set it to 0",
                T::NAME
            )));
        }
        Ok(copy)
    }
}

/// The size of every struct of an array, which the first one says.
unsafe fn size_of_all<T: HostStruct>(what: &str, from: *const T, count: usize) -> Outcome<usize> {
    if from.is_null() {
        return Err(Failure::argument(format!("{what} is NULL, but {count} are needed: give the array")));
    }
    let size = check_size::<T>(unsafe { from.cast::<u32>().read_unaligned() })?;
    stride_of(&what, false, count, size, size)
}

/// Structs of an array, all of the size that the first one says.
///
/// # Safety
/// `from` is NULL or holds `count` structs.
pub unsafe fn structs_in<T: HostStruct>(what: &str, from: *const T, count: usize) -> Outcome<Vec<T>> {
    let structs = unsafe { Structs::new(what, from, count) }?;
    let mut all = reserved(count, what)?;
    for index in 0..count {
        all.push(structs.get(index)?);
    }
    Ok(all)
}

/// Structs of an array of the caller's, all of the size that the first one says.
pub struct Structs<T> {
    start: *const u8,
    size: usize,
    count: usize,
    element: std::marker::PhantomData<T>,
}

impl<T: HostStruct> Structs<T> {
    /// Checks that all are of one size.
    ///
    /// # Safety
    /// `from` is NULL or holds `count` structs, for as long as this is used.
    pub unsafe fn new(what: &str, from: *const T, count: usize) -> Outcome<Self> {
        let mut size = size_of::<T>();
        if count > 0 {
            size = unsafe { size_of_all(what, from, count) }?;
        }
        for index in 0..count {
            let own = unsafe { from.cast::<u8>().add(index * size).cast::<u32>().read_unaligned() };
            if own as usize != size {
                return Err(Failure::argument(format!(
                    "struct_size of {what}[{index}] is {own}, but of the first it is {size}: give all the same"
                )));
            }
        }
        Ok(Self { start: from.cast(), size, count, element: std::marker::PhantomData })
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// A copy of one of them.
    pub fn get(&self, index: usize) -> Outcome<T> {
        assert!(index < self.count);
        // SAFETY: within what the caller said that the array holds.
        unsafe { struct_in(self.start.add(index * self.size).cast()) }
    }
}

/// Checks a struct that is to be written, so that errors come before work.
///
/// # Safety
/// As [`struct_out`].
pub unsafe fn check_struct_out<T: HostStruct>(to: *mut T) -> Outcome {
    if !to.is_null() {
        check_size::<T>(unsafe { to.cast::<u32>().read_unaligned() })?;
    }
    Ok(())
}

/// Writes `value` into the caller's struct, as much of it as that one has; its size stays.
///
/// # Safety
/// `to` points to as many bytes as its first number says.
pub unsafe fn struct_out<T: HostStruct>(to: *mut T, value: &T) -> Outcome {
    if to.is_null() {
        return Err(Failure::argument(format!("{} is NULL: give one", T::NAME)));
    }
    unsafe {
        let size = check_size::<T>(to.cast::<u32>().read_unaligned())?;
        write_struct(to, size, value);
    }
    Ok(())
}

/// Writes `value` into a struct of `size` bytes; what a newer host's struct has beyond ours stays.
unsafe fn write_struct<T: HostStruct>(to: *mut T, size: usize, value: &T) {
    let rest = size.min(size_of::<T>()) - 4;
    // SAFETY: both structs have as many bytes.
    unsafe { to.cast::<u8>().add(4).copy_from_nonoverlapping((&raw const *value).cast::<u8>().add(4), rest) };
}

/// Writes `values` into the caller's array, whose first struct says how large each is; all get that size.
///
/// # Safety
/// `to` is NULL or holds `capacity` structs.
pub unsafe fn structs_out<T: HostStruct>(what: &str, to: *mut T, capacity: usize, values: &[T]) -> Outcome {
    let count = values.len();
    if to.is_null() || (capacity == 0 && count == 0) {
        return Ok(());
    }
    if capacity < count {
        return Err(too_small(what, capacity, count));
    }
    unsafe {
        let size = size_of_all(what, to, count)?;
        for (index, value) in values.iter().enumerate() {
            let to = to.cast::<u8>().add(index * size).cast::<T>();
            to.cast::<u32>().write_unaligned(size as u32);
            write_struct(to, size, value);
        }
    }
    Ok(())
}

fn too_small(what: impl Display, capacity: usize, count: usize) -> Failure {
    let message = format!("{what} can hold {capacity}, but {count} are needed: give a larger array");
    Failure::new(SDEF_STATUS_BUFFER_TOO_SMALL, message)
}

/// Writes a result where the caller wants it.
///
/// # Safety
/// `to` is NULL or can be written.
pub unsafe fn write_out<T: Copy>(to: *mut T, value: T) {
    if !to.is_null() {
        unsafe { to.write_unaligned(value) };
    }
}

/// Refuses a result that the caller gives no place for.
pub fn not_null<T>(what: &str, to: *mut T) -> Outcome {
    if to.is_null() {
        return Err(Failure::argument(format!("{what} is NULL: give a place for the result")));
    }
    Ok(())
}

/// An array of the caller's that results go to, checked; `None` where the caller gave none.
#[derive(Clone, Copy)]
pub struct Output<T> {
    start: *mut u8,
    count: usize,
    stride: usize,
    element: std::marker::PhantomData<T>,
}

impl<T: Plain> Output<T> {
    /// No array.
    pub fn none() -> Self {
        Self { start: std::ptr::null_mut(), count: 0, stride: 1, element: std::marker::PhantomData }
    }

    /// Checks that `count` elements fit.
    ///
    /// # Safety
    /// `start` is NULL or holds `capacity` elements that begin `stride` bytes apart, for as long as this is used.
    pub unsafe fn new(
        what: impl Display,
        start: *mut T,
        count: usize,
        capacity: usize,
        stride: usize,
    ) -> Outcome<Self> {
        if start.is_null() {
            return Ok(Self::none());
        }
        if capacity < count {
            return Err(too_small(what, capacity, count));
        }
        let stride = stride_of(&what, false, count, stride, size_of::<T>())?;
        Ok(Self { start: start.cast(), count, stride, element: std::marker::PhantomData })
    }

    /// Whether there is an array to write to.
    pub fn is_given(&self) -> bool {
        !self.start.is_null()
    }

    /// Writes `values`, of which there are as many as were checked.
    pub fn write_all(&self, values: &[T]) {
        let count = self.count.min(values.len());
        if self.stride == size_of::<T>() {
            // SAFETY: the caller's array holds as many.
            unsafe { self.start.copy_from_nonoverlapping(values.as_ptr().cast(), count * self.stride) };
        } else {
            self.write_each(values.iter().copied());
        }
    }

    /// Writes `values`, of which there are as many as were checked; those of no array are not made.
    pub fn write_each(&self, values: impl IntoIterator<Item = T>) {
        for (index, value) in values.into_iter().take(self.count).enumerate() {
            // SAFETY: the caller's array holds as many.
            unsafe { self.start.add(index * self.stride).cast::<T>().write_unaligned(value) };
        }
    }

    /// Writes `values` at these of the elements that were checked, and `other` everywhere else.
    pub fn write_sparse(self, indices: &[u32], values: &[T], other: T) {
        let others = [other; 512];
        for first in (0..self.count).step_by(others.len()) {
            self.from(first).write_all(&others);
        }
        for (&index, &value) in indices.iter().zip(values) {
            self.from(index as usize).write_all(&[value]);
        }
    }

    /// What begins at `index`.
    pub fn from(self, index: usize) -> Self {
        let index = index.min(self.count);
        let start = self.start.wrapping_add(index * self.stride);
        Self { start, count: self.count - index, ..self }
    }
}

// SAFETY: a host's array that one call writes to, each element from one thread.
unsafe impl<T: Send> Send for Output<T> {}

impl<T: Plain + Send> Place<T> for Output<T> {
    fn cut(self, index: usize) -> (Self, Self) {
        (Self { count: index.min(self.count), ..self }, self.from(index))
    }

    fn write(&mut self, first: usize, values: &[T]) {
        self.from(first).write_all(values);
    }
}

/// Writes a text into the caller's bytes, and how many it takes.
///
/// # Safety
/// `to` is NULL or holds `capacity` bytes; `size` is NULL or can be written.
pub unsafe fn text_out(text: &str, to: *mut c_char, capacity: usize, size: *mut usize) -> Outcome {
    let need = text.len() + 1;
    unsafe { write_out(size, need) };
    if to.is_null() {
        return Ok(());
    }
    if capacity < need {
        return Err(Failure::new(
            SDEF_STATUS_BUFFER_TOO_SMALL,
            format!("the text takes {need} bytes with its NUL, but there is room for {capacity}: give more"),
        ));
    }
    unsafe {
        to.cast::<u8>().copy_from_nonoverlapping(text.as_ptr(), text.len());
        to.add(text.len()).write(0);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A struct that has grown by its last field.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Grown {
        struct_size: u32,
        first: u32,
        later: f64,
    }
    unsafe impl Plain for Grown {}
    unsafe impl HostStruct for Grown {
        const NAME: &'static str = "Grown";
        const FIRST_SIZE: usize = core::mem::offset_of!(Grown, later);

        fn defaults() -> Self {
            Self { struct_size: 0, first: 0, later: 7.0 }
        }
    }

    fn grown(struct_size: u32) -> Grown {
        Grown { struct_size, first: 3, later: 4.0 }
    }

    /// What only a newer header knows must not be set: 0 and NAN stand for that.
    #[test]
    fn what_a_newer_struct_has_set_is_refused() {
        #[repr(C)]
        struct Newer(Grown, f64);
        let read = |newest| {
            let newer = Newer(grown(24), newest);
            unsafe { struct_in((&raw const newer).cast::<Grown>()) }
        };
        for unset in [0.0, f64::NAN, -f64::NAN] {
            assert_eq!(read(unset).unwrap().later, 4.0);
        }
        let refused = read(0.5).unwrap_err();
        assert!(refused.message.starts_with("Grown has a field set at byte 20"), "{}", refused.message);
    }

    /// Hosts that were built with version 1 of the ABI are never told that their structs are too small.
    #[test]
    #[cfg(target_pointer_width = "64")]
    fn no_struct_must_be_larger_than_in_the_frozen_version() {
        use crate::ffi::{character::*, deformer::*, options::*, style_handle::*};
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/headers/abi_1.txt");
        let Ok(frozen) = std::fs::read_to_string(file) else {
            println!("skipped: there is no {file}, as in a package from a registry");
            return;
        };
        let sizes: Vec<(&str, usize)> = frozen
            .lines()
            .filter_map(|line| line.strip_prefix("SIZE(")?.strip_suffix(");")?.split_once(", "))
            .map(|(name, size)| (name, size.parse().unwrap()))
            .collect();
        macro_rules! asked { ($($name:ident)*) => { [$((<$name as HostStruct>::NAME, <$name as HostStruct>::FIRST_SIZE)),*] } }
        let asked = asked!(SdefGroupSettings SdefBoneGroup SdefGivenJoint SdefOptions SdefMesh SdefImage SdefFaceHints
            SdefMorphTarget SdefSkeleton SdefCharacterInfo SdefBone SdefStyleNumbers SdefMeshResult SdefCollider SdefSpringBall
            SdefGroup SdefFigure SdefReport);
        for own in asked {
            assert!(sizes.contains(&own), "{own:?}");
        }
        // Beside them: a status, three handles, and the error, which knows its own size.
        assert_eq!(sizes.len(), asked.len() + 5, "{sizes:?}");
    }

    #[test]
    fn what_an_older_struct_lacks_has_its_default() {
        let read = |size| unsafe { struct_in(&grown(size)) };
        assert_eq!(read(16).unwrap().later, 4.0);
        assert_eq!(read(8).unwrap(), Grown { struct_size: 8, first: 3, later: 7.0 });
    }

    #[test]
    fn a_struct_smaller_than_it_ever_was_is_refused_with_both_sizes() {
        for size in [0, 4, 7, 12 + 1, 1 << 17] {
            let failure = check_size::<Grown>(size).unwrap_err();
            assert_eq!(failure.status, SDEF_STATUS_BAD_ARGUMENT);
            let said = format!(
                "struct_size of Grown is {size}: set it to sizeof(Grown), 16 in this library's header, 8 at least"
            );
            assert_eq!(failure.message, said);
        }
    }

    #[test]
    fn an_older_struct_is_written_as_far_as_it_goes() {
        let mut to = grown(8);
        unsafe { struct_out(&mut to, &Grown { struct_size: 16, first: 5, later: 6.0 }) }.unwrap();
        assert_eq!(to, Grown { struct_size: 8, first: 5, later: 4.0 });
    }

    #[test]
    fn structs_of_an_array_have_one_size() {
        let mixed = [grown(16), grown(8)];
        let failure = unsafe { structs_in("them", mixed.as_ptr(), 2) }.unwrap_err();
        assert!(failure.message.starts_with("struct_size of them[1] is 8, but of the first it is 16"));
        let mut to = [grown(16), Grown { struct_size: 0, ..grown(0) }];
        unsafe { structs_out("them", to.as_mut_ptr(), 2, &[grown(0), grown(0)]) }.unwrap();
        assert_eq!(to, [grown(16); 2]);
        let failure = unsafe { structs_out("them", to.as_mut_ptr(), 1, &to.clone()) }.unwrap_err();
        assert_eq!(failure.status, SDEF_STATUS_BUFFER_TOO_SMALL);
    }
}
