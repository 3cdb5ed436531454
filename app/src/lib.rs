//! The Hysteron app: state, jobs and views, apart from each other.
