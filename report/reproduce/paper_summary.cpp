#include "canyon/report/reproduce/paper_summary.h"

#include <nlohmann/json.hpp>

#include "canyon/core/files/files.h"
#include "canyon/report/read/json_fields.h"

namespace canyon::report {
namespace {

/// Reads the elements of a list, each by `read`.
template <class T, class Read>
std::vector<T> read_each(const JsonFields& from, const char* key, Read read) {
  std::vector<T> out;
  for (const auto& [node, place] : from.list(key))
    out.push_back(read(JsonFields(node, from.file(), place, from.error())));
  return out;
}

std::vector<std::string> texts(const JsonFields& f, const char* key) {
  std::vector<std::string> out;
  for (const auto& [node, place] : f.list(key))
    if (node->is_string()) out.push_back(node->get<std::string>());
  return out;
}

PaperOurs read_ours(const JsonFields& f) {
  return {f.required_text("form"), f.number("value"), f.number("low"), f.number("high"), f.number("n")};
}

PaperNumber read_number(const JsonFields& f) {
  return {.what = f.required_text("what"),
          .unit = f.text("unit"),
          .nearest = f.text("nearest"),
          .paper = f.number("paper"),
          .real = f.number("real"),
          .ratio = f.number("ratio"),
          .ours = read_each<PaperOurs>(f, "ours", read_ours)};
}

PaperLine read_line(const JsonFields& f) {
  const std::size_t size = f.list("x").size();
  return {.panel = f.required_text("panel"),
          .unit = f.text("unit"),
          .name = f.required_text("name"),
          .x = f.numbers("x", size),
          .y = f.numbers("y", size),
          .points = f.flag("points"),
          .from_above = f.flag("from_above"),
          .labels = texts(f, "labels")};
}

PaperSection read_section(const JsonFields& f) {
  return {.name = f.required_text("name"),
          .title = f.required_text("title"),
          .paper_says = f.text("paper_says"),
          .made = f.text("made"),
          .x_label = f.text("x_label"),
          .difference = texts(f, "difference"),
          .rows = read_each<PaperNumber>(f, "rows", read_number),
          .curves = read_each<PaperLine>(f, "curves", read_line)};
}

}  // namespace

Result<PaperSummary> read_paper_summary(const std::string& path) {
  CANYON_TRY(const std::string text, read_text_file(path));
  CANYON_TRY(const JsonFile file, JsonFile::parse(text, path));
  std::optional<Error> error;
  const JsonFields f(&file.root(), file, "", error);
  PaperSummary out{.ephemeris = f.required_text("ephemeris"),
                   .start = f.required_text("start"),
                   .draws = f.number("draws"),
                   .missions = f.number("missions"),
                   .parts = read_each<PaperSection>(f, "parts", read_section)};
  if (error) return *error;
  return out;
}

}  // namespace canyon::report
