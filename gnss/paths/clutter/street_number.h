#pragma once

#include <cstdint>

#include "canyon/core/model_choice.h"

namespace canyon::gnss {

/// Of the parameters of the table of clutter: so many numbers farther on, what stands in the street is drawn anew
/// (`clutter_street`).
void move_to_street(ModelParameters& clutter, std::int64_t by);

}  // namespace canyon::gnss
