//! Access to the plane's types from code for any dimension, for drawings of the plane.

use std::any::Any;

/// A thing in D dimensions as the thing of the plane that it is; none in space.
pub fn in_plane<Given: Any, OfPlane: Any>(thing: &Given) -> Option<&OfPlane> {
    (thing as &dyn Any).downcast_ref()
}
