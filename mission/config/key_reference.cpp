#include "canyon/mission/config/key_reference.h"

#include "canyon/core/check.h"
#include "canyon/core/config/config.h"
#include "canyon/core/process/embedded.h"
#include "canyon/mission/config/mission_config.h"

namespace canyon::mission {
namespace {

constexpr const char* kIntroduction =
    R"(# The keys of a mission file

This page is written by `canyon keys`; `canyon keys > docs/mission.md` brings it up to date after a change.

A mission file is TOML. Beside the sections below it may hold

- `base = "vicksburg"`, before any section: start from that built-in mission and change what differs;
- `[fidelity.NAME]` sections, such as `[fidelity.mine.gnss]`: what the fidelity NAME (letters, digits, `-`, `_`) lays over the
  mission. One that is not built in starts from another: from `base = "low"` if `[fidelity.NAME]` says so, else from `high`.
  What all runs of a comparison share cannot stand there: `scene`, `time`, `success`, `run.name`, `run.seed`,
  `vehicle.start_m`, `vehicle.start_heading_deg` and the waypoints.

Later layers win: the base mission, the built-in fidelity (at the foot of this page), the file's sections, the file's
`[fidelity.NAME]`, options of the command line. A layer that names a receiver (`[gnss] receiver`) has its figures just below it. An array, such as the waypoints, is replaced as a whole. Unknown keys are errors.
A relative path starts at the folder of the file it is written in; on the command line, at the current directory.

The default is that of a file without `base`; the columns "range" and "meaning" are what `canyon` itself checks and knows.
)";

/// In a Markdown table a bar would end the cell.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

std::string table(const std::vector<FieldDoc>& rows) {
  std::string out = "\n| key | unit | default | range | meaning |\n|---|---|---|---|---|\n";
  for (const FieldDoc& row : rows)
    out += "| `" + row.key + "` | " + row.unit + " | " + cell(row.default_value) + " | " + cell(row.range) + " | " +
           cell(row.meaning) + " |\n";
  return out;
}

/// One heading and table per section of the file.
class SectionWriter final : public FieldVisitor {
 public:
  explicit SectionWriter(std::string& out) : out_(out) {}

  void number(const char* key, double&, Range, const char*) override { refuse(key); }
  void integer(const char* key, std::int64_t&, Range, const char*) override { refuse(key); }
  void flag(const char* key, bool&, const char*) override { refuse(key); }
  void text(const char* key, std::string&, const char*) override { refuse(key); }
  void file(const char* key, std::string&, std::string_view, const char*) override { refuse(key); }
  void files(const char* key, std::vector<std::string>&, const char*) override { refuse(key); }
  void choice(const char* key, std::string&, const std::vector<std::string>&, const char*) override { refuse(key); }
  void choices(const char* key, std::vector<std::string>&, const std::vector<std::string>&, const char*) override {
    refuse(key);
  }
  void numbers(const char* key, std::vector<double>&, std::size_t, Range, const char*) override { refuse(key); }
  void texts(const char* key, std::vector<std::string>&, const char*) override { refuse(key); }

 protected:
  void group_impl(const char* key, const char* doc, const std::function<void(FieldVisitor&)>& body) override {
    out_ += "\n## [" + std::string(key) + "]: " + doc + "\n" + table(documented_fields("", body));
  }
  void list_impl(const char* key, const char*, std::size_t, const std::function<void(std::size_t)>&,
                 const std::function<void(std::size_t, FieldVisitor&)>&) override {
    refuse(key);
  }

 private:
  static void refuse(const char* key) { CANYON_CHECK(false, "a key outside of sections: ", key); }

  std::string& out_;
};

}  // namespace

std::string key_reference() {
  std::string out = kIntroduction;
  MissionConfig config;
  SectionWriter writer(out);
  visit(writer, config);
  const auto fidelities = embedded_file("missions/fidelities.toml");
  CANYON_CHECK(fidelities.has_value(), "not embedded");
  return out + "\n## The built-in fidelities\n\n```toml\n" + std::string(*fidelities) + "```\n";
}

}  // namespace canyon::mission
