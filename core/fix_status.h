#pragma once

#include "canyon/core/messages.h"

namespace canyon {

/// As files of epochs name it: "none", "single", "differential".
const char* fix_status_name(FixStatus status);

}  // namespace canyon
