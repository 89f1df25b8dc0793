#pragma once

#include <nlohmann/json_fwd.hpp>

namespace canyon::apps {

using Json = nlohmann::ordered_json;

/// A number, or null where it is undefined: NaN does not exist in JSON.
Json or_null(double value);

}  // namespace canyon::apps
