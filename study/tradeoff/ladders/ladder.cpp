#include "canyon/study/tradeoff/ladders/ladder.h"

#include "canyon/core/process/embedded.h"

namespace canyon::study {

const std::vector<std::string>& tradeoff_parts() {
  static const std::vector<std::string> parts{"gnss",         "imu",     "lidar",      "fusion",
                                              "registration", "mission", kRecordedPart};
  return parts;
}

void visit(FieldVisitor& f, Ladder& c) {
  f.choice("part", c.part, tradeoff_parts(), "which part of canyon it is of");
  f.text("key", c.key, "what it varies");
  f.texts("rungs", c.rungs, "\"rows\", \"links\" or names");
  f.numbers("values", c.values, 0, kPositive, "numbers in place of rungs");
  f.text("probe", c.probe, "what is measured");
  f.text("reference", c.reference, "what errors are measured against");
  f.texts("series", c.series, "rungs that tell what the finest still errs");
  f.texts("fixed", c.fixed, "settings under which it is measured");
  f.integer("samples", c.samples, kNotNegative, "at most so many");
  f.text("for_each", c.for_each, "a ladder for every row of this key");
  f.flag("chosen", c.chosen, "moved by --tolerance and --budget-cpu");
}

void visit(FieldVisitor& f, NoLadder& c) {
  f.text("key", c.key, "a choice of the mission file");
  f.text("reason", c.reason, "why it is no ladder");
}

void visit(FieldVisitor& f, Ladders& c) {
  f.list("ladder", c.ladder, "ladders");
  f.list("no_ladder", c.no_ladder, "choices that are none");
}

Result<Ladders> parse_ladders(std::string_view toml, const std::string& file_name) {
  CANYON_TRY(const ConfigNode tree, ConfigNode::parse(toml, file_name));
  Ladders ladders;
  CANYON_TRY_STATUS(read_config(&tree, "", ladders));
  return ladders;
}

const Ladders& built_in_ladders() {
  static const Ladders ladders = [] {
    constexpr const char* kFile = "study/tradeoff/ladders/ladders.toml";
    const auto text = embedded_file(kFile);
    CANYON_CHECK(text.has_value(), "not embedded: ", kFile);
    return *parse_ladders(*text, kFile);  // one that cannot be read throws with its error
  }();
  return ladders;
}

std::pair<std::string, std::string> cut_setting(const std::string& setting) {
  const auto sign = setting.find('=');
  CANYON_CHECK(sign != std::string::npos, "no setting: ", setting);
  return {setting.substr(0, sign), setting.substr(sign + 1)};
}

}  // namespace canyon::study
