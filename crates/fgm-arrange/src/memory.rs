/// Bytes of scratch that are kept from one arrangement to the next, for each list. The layers of a
/// part need less; what a huge input needs is given back as soon as it is used, so that the
/// stages' peaks do not add up.
const KEPT: usize = 8 << 20;

/// Empties a list that is no longer needed, and gives its memory back if it is large.
pub(crate) fn rest<T>(list: &mut Vec<T>) {
    if list.capacity() * size_of::<T>() > KEPT {
        *list = Vec::new();
    } else {
        list.clear();
    }
}
