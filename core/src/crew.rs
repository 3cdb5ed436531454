//! Independent parts of a computation, done by whoever is there.

use std::fmt;
use std::sync::{Arc, Mutex};

/// Does independent parts of a computation: in any order, on one thread or on many. The result is the same to the last
/// digit.
pub trait Hands: Send + Sync {
    /// Parts that are worth handing out at a time.
    fn width(&self) -> usize {
        1
    }

    /// Calls `part` with every number below `count`, and returns when all are done. A part may hand out parts of its
    /// own.
    fn each(&self, count: usize, part: &(dyn Fn(usize) + Sync));
}

/// One part after the other.
struct Alone;

impl Hands for Alone {
    fn each(&self, count: usize, part: &(dyn Fn(usize) + Sync)) {
        (0..count).for_each(part);
    }
}

/// Who does the parts; by default, one after the other.
#[derive(Clone)]
pub struct Crew(Arc<dyn Hands>);

impl Crew {
    /// These hands.
    pub fn new(hands: impl Hands + 'static) -> Self {
        Self(Arc::new(hands))
    }

    /// Parts that are worth handing out at a time, at least one.
    pub(crate) fn width(&self) -> usize {
        self.0.width().max(1)
    }

    /// What `part` gives for every number below `count`, in order.
    pub(crate) fn gather<T: Send>(&self, count: usize, part: impl Fn(usize) -> T + Sync) -> Vec<T> {
        if count < 2 {
            return (0..count).map(part).collect();
        }
        let results: Vec<Mutex<Option<T>>> = (0..count).map(|_| Mutex::default()).collect();
        self.0.each(count, &|i| {
            let value = part(i);
            if let Some(Ok(mut result)) = results.get(i).map(Mutex::lock) {
                *result = Some(value);
            }
        });
        let results = results.into_iter().enumerate();
        let done = |result: Mutex<Option<T>>| result.into_inner().ok().flatten();
        // What hands have left out is done here.
        results
            .map(|(i, result)| done(result).unwrap_or_else(|| part(i)))
            .collect()
    }

    /// Calls `part` with every item.
    pub(crate) fn for_each<T: Send>(&self, items: Vec<T>, part: impl Fn(T) + Sync) {
        let items: Vec<Mutex<Option<T>>> = items.into_iter().map(|i| Mutex::new(Some(i))).collect();
        self.gather(items.len(), |i| {
            let item = items[i].lock().ok().and_then(|mut item| item.take());
            item.into_iter().for_each(&part);
        });
    }
}

impl Default for Crew {
    fn default() -> Self {
        Self::new(Alone)
    }
}

impl fmt::Debug for Crew {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Crew")
            .field("width", &self.width())
            .finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hands that do the last part first and leave out the second.
    struct Careless;

    impl Hands for Careless {
        fn each(&self, count: usize, part: &(dyn Fn(usize) + Sync)) {
            (0..count).rev().filter(|i| *i != 1).for_each(part);
        }
    }

    #[test]
    fn every_part_is_done_once_and_in_its_place_whoever_does_it() {
        for crew in [Crew::default(), Crew::new(Careless)] {
            assert_eq!(crew.gather(4, |i| 10 * i), [0, 10, 20, 30]);
            let mut numbers = [1, 2, 3];
            crew.for_each(numbers.iter_mut().collect(), |n| *n *= 2);
            assert_eq!(numbers, [2, 4, 6]);
        }
    }
}
