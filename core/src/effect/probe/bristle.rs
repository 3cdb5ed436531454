//! Where a soft contact of dry friction would be if the body moved as measured.

use super::Probe;
use crate::model::dahl;

impl Probe {
    /// Deflection at every sample, as a share of that at which it slips (-1 to 1), of a contact whose friction builds
    /// up over this displacement (in the unit of position).
    pub fn deflection(&self, displacement: f64) -> Vec<f64> {
        let mut bent = 0.0;
        let mut last = self.position.first().copied().unwrap_or(0.0);
        let follow = |x: &f64| {
            bent = dahl(bent, (x - last) / displacement, 1.0);
            last = *x;
            bent
        };
        self.position.iter().map(follow).collect()
    }
}
