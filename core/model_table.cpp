#include "canyon/core/model_table.h"

#include "canyon/core/config/config.h"
#include "canyon/core/config/text.h"

namespace canyon {

Error unknown_name(std::string key, std::string_view name, const std::vector<std::string>& known) {
  const std::string nearest = nearest_word(name, known);
  return Error{
      .key = std::move(key),
      .what = "unknown name \"" + std::string(name) + "\"",
      .expected = "one of " + quoted_list(known) + (nearest.empty() ? "" : "; nearest is \"" + nearest + "\"")};
}

}  // namespace canyon
