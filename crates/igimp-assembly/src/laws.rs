//! Constitutive laws as bodies and threads share them.

use std::sync::Arc;

use igimp_material::ConstitutiveModel;

/// A constitutive law that several bodies and threads share.
pub type SharedLaw = Arc<dyn ConstitutiveModel>;
