#include "canyon/core/fix_status.h"

#include "canyon/core/check.h"

namespace canyon {

const char* fix_status_name(FixStatus status) {
  switch (status) {
    case FixStatus::kNone:
      return "none";
    case FixStatus::kSingle:
      return "single";
    case FixStatus::kDifferential:
      return "differential";
  }
  CANYON_CHECK(false, "status ", static_cast<int>(status));
}

}  // namespace canyon
