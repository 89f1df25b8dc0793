#include <cstdio>
#include <memory>

#include <nlohmann/json.hpp>

#include "canyon/apps/line/verb.h"
#include "canyon/core/config/config.h"
#include "canyon/core/files/json_text.h"
#include "canyon/core/output/json.h"
#include "canyon/mission/config/key_reference.h"
#include "canyon/mission/config/mission_config.h"
#include "canyon/study/fuse/config.h"
#include "canyon/study/results/figures.h"

namespace canyon::apps {

namespace {

Json keys_json() {
  mission::MissionConfig config;
  Json out{{"keys", Json::array()}};
  for (const FieldDoc& row : documented_fields("", [&config](FieldVisitor& f) { visit(f, config); }))
    out["keys"].push_back({{"key", row.key},
                           {"unit", row.unit},
                           {"default", row.default_value},
                           {"range", row.range},
                           {"meaning", row.meaning}});
  return out;
}

VerbAction declare(Arguments& arguments) {
  struct Options {
    CommonOptions common;
    bool figures = false, fuse = false;
  };
  const auto options = std::make_shared<Options>();
  declare_common(arguments, options->common);
  arguments.flag("--figures", options->figures, "the figures of a run in place of the keys of a mission");
  arguments.flag("--fuse", options->fuse, "the keys of canyon fuse --config, but those of [fusion]");
  return [options]() -> Result<int> {
    if (options->fuse) {
      std::fputs(study::fuse_key_reference().c_str(), stdout);
      return 0;
    }
    if (options->common.json) {
      const Json json = options->figures ? Json{{"figures", study::figure_descriptions()}} : keys_json();
      std::printf("%s\n", json_text(json).c_str());
    } else {
      std::fputs((options->figures ? study::figure_reference() : mission::key_reference()).c_str(), stdout);
    }
    return 0;
  };
}

}  // namespace

Verb keys_verb() {
  return {"keys", "all keys of a mission file, with units, defaults and ranges; or all figures of a run",
          "canyon keys > mission.md", declare};
}

}  // namespace canyon::apps
