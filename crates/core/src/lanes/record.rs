//! Records in memory, one per contact, that are read and written in columns: one number of each
//! record per lane.

use super::Lane;
use std::marker::PhantomData;
use std::ops::Deref;

/// A structure that consists of numbers only, which may be those of several contacts.
///
/// Structures with an even number of entries that are read in columns are aligned to 16 bytes, so
/// that no pair of numbers spans two cache lines.
///
/// # Safety
/// `Self` must consist of `f64` only, and `With<L>` of as many `L`, in the same order (`repr(C)`).
pub unsafe trait Record: Copy {
    /// The structure with a lane in place of each number.
    type With<L: Lane>: Copy;
    /// Number of numbers.
    const COUNT: usize = size_of::<Self>() / size_of::<f64>();
}

// SAFETY: the structure is one number.
unsafe impl Record for f64 {
    type With<L: Lane> = L;
}

/// Implements [`Record`] for a structure over a dimension (`Space`, which must be in scope) and a
/// lane.
macro_rules! record {
    ($name:ident) => {
        // SAFETY: the structure is `repr(C)`, and its fields have the type of its lane or are
        // records of it.
        unsafe impl<S: Space> $crate::lanes::Record for $name<S, f64> {
            type With<L: $crate::lanes::Lane> = $name<S, L>;
        }
    };
}
pub(crate) use record;

/// Structures of several contacts, anywhere in memory, from which records are read.
pub(crate) struct Batch<'a, T, L: Lane>(L::Each<*mut T>, PhantomData<&'a T>);

impl<T, L: Lane> Clone for Batch<'_, T, L> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T, L: Lane> Copy for Batch<'_, T, L> {}

impl<'a, T, L: Lane> Batch<'a, T, L> {
    /// Returns a part of each structure; see [`part`].
    ///
    /// # Safety
    /// `of` must give a field of its structure.
    #[inline(always)]
    pub unsafe fn part<P>(&self, of: impl Fn(*mut T) -> *mut P) -> Batch<'a, P, L> {
        Batch(L::map(self.0, of), PhantomData)
    }

    #[inline(always)]
    pub fn read(&self) -> T::With<L>
    where
        T: Record,
    {
        // SAFETY: the structures are borrowed.
        unsafe { L::gather(self.0) }
    }
}

impl<'a, T> Batch<'a, T, f64> {
    /// Returns a batch of one structure.
    #[inline(always)]
    pub fn one(of: &'a T) -> Self {
        Self(std::ptr::from_ref(of).cast_mut(), PhantomData)
    }
}

/// A batch whose records are written, too.
pub(crate) struct BatchMut<'a, T, L: Lane>(Batch<'a, T, L>, PhantomData<&'a mut T>);

impl<'a, T, L: Lane> Deref for BatchMut<'a, T, L> {
    type Target = Batch<'a, T, L>;
    #[inline(always)]
    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<'a, T, L: Lane> BatchMut<'a, T, L> {
    /// # Safety
    /// The structures must be valid, and nobody else may use them, while the batch is used; several
    /// lanes may share one if it does not matter what is written there.
    #[inline(always)]
    pub unsafe fn new(each: L::Each<*mut T>) -> Self {
        Self(Batch(each, PhantomData), PhantomData)
    }

    /// Returns a part of each structure; see [`part_mut`].
    ///
    /// # Safety
    /// `of` must give a field of its structure.
    #[inline(always)]
    pub unsafe fn part_mut<P>(&mut self, of: impl Fn(*mut T) -> *mut P) -> BatchMut<'_, P, L> {
        BatchMut(Batch(L::map(self.0.0, of), PhantomData), PhantomData)
    }

    #[inline(always)]
    pub fn write(&mut self, value: &T::With<L>)
    where
        T: Record,
    {
        // SAFETY: see `new`.
        unsafe { L::scatter(self.0.0, value) }
    }

    /// Writes the values in the lanes of a mask.
    #[inline(always)]
    pub fn write_where(&mut self, mask: L::Mask, value: &T::With<L>)
    where
        T: Record,
    {
        // SAFETY: see `new`.
        unsafe { L::scatter_where(mask, self.0.0, value) }
    }
}

impl<'a, T> BatchMut<'a, T, f64> {
    /// Returns a batch of one structure.
    #[inline(always)]
    pub fn one(of: &'a mut T) -> Self {
        let of: *mut T = of;
        Self(Batch(of, PhantomData), PhantomData)
    }
}

/// Gives a field of each structure of a batch, for reading.
macro_rules! part {
    ($batch:expr, $($field:tt)+) => {
        // SAFETY: the macro names a field.
        unsafe { $batch.part(|x| &raw mut (*x).$($field)+) }
    };
}
/// Gives a field of each structure of a batch, for writing.
macro_rules! part_mut {
    ($batch:expr, $($field:tt)+) => {
        // SAFETY: the macro names a field.
        unsafe { $batch.part_mut(|x| &raw mut (*x).$($field)+) }
    };
}
pub(crate) use {part, part_mut};
