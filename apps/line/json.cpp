#include "canyon/apps/line/json.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace canyon::apps {

Json or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace canyon::apps
