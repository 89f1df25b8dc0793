#pragma once

#include "canyon/core/model_table.h"
#include "canyon/mission/config/mission_config.h"

namespace canyon::study {

/// How much a removal takes away: of several that rescue a mission the narrowest names the cause.
enum class Breadth { kOneError, kSeveral, kNavigation };

/// A source of error that a run can be driven again without. All other draws stay the same bits.
struct Removal {
  void (*remove)(mission::MissionConfig& config);
  Breadth breadth;
  bool from_start;       ///< it acts at the start alone, so it is taken away there
  const char* contains;  ///< the row that it takes away as well; may be null
  const char* cause;     ///< what is to blame where its removal rescues: "errors of reflected signals"
};
ModelTable<Removal> removals();

}  // namespace canyon::study
