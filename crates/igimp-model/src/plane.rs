//! What is of the plane in code that knows no dimension: drawings of the plane are made of it.

use std::any::Any;

/// A thing in D dimensions as the thing of the plane that it is; none in space.
pub fn in_plane<Given: Any, OfPlane: Any>(thing: &Given) -> Option<&OfPlane> {
    (thing as &dyn Any).downcast_ref()
}
