#pragma once

namespace canyon {

/// Gives memory that is free back to the system, holes between what is in use included: after something large, such as
/// a run's maps, has been let go. Costs some milliseconds; does nothing where the C library has no such call.
void give_back_free_memory();

}  // namespace canyon
