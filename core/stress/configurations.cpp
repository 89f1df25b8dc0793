// Configurations: fields of every kind read, overlaid and written, and each mistake in words with its line and key.
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "canyon/core/config/config.h"
#include "canyon/core/config/text.h"
#include "canyon/core/stress/subjects.h"
#include "canyon/core/stress_rows.h"

namespace canyon {
namespace {

struct MadeItem {
  double size_m = 2.0;
  std::string name = "it";
};
void visit(FieldVisitor& f, MadeItem& c) {
  f.number("size_m", c.size_m, kPositive, "how large");
  f.text("name", c.name, "what it is");
  f.old_key("weight", "size_m");
}

struct MadeConfig {
  double rate_hz = 5.0, must_db = std::numeric_limits<double>::quiet_NaN();
  std::int64_t count = 3;
  bool on = false;
  std::string text = "a", file = "built_in", kind = "red";
  std::vector<std::string> files, texts, kinds{"red"};
  std::vector<double> list{1.0, 2.0};
  Eigen::Vector3d arm_m{1.0, 2.0, 3.0};
  std::optional<double> limit_deg;
  MadeItem group;
  std::vector<MadeItem> items;
};
void visit(FieldVisitor& f, MadeConfig& c) {
  const std::vector<std::string> kinds{"red", "green", "blue"};
  f.number("rate_hz", c.rate_hz, {0.1, 20.0}, "how often");
  f.number("must_db", c.must_db, kNotNegative, "has to be there");
  f.integer("count", c.count, {0.0, 9.0}, "how many");
  f.flag("on", c.on, "whether");
  f.text("text", c.text, "any");
  f.file("file", c.file, ".csv", "from where");
  f.files("files", c.files, "from where");
  f.texts("texts", c.texts, "any");
  f.choice("kind", c.kind, kinds, "which");
  f.choices("kinds", c.kinds, kinds, "which");
  f.numbers("list", c.list, 0, kAnyNumber, "some");
  f.vector3("arm_m", c.arm_m, {-9.0, 9.0}, "where");
  f.optional_number("limit_deg", c.limit_deg, -1.0, {0.0, 90.0}, "how far");
  f.group("group", c.group, "one");
  f.list("items", c.items, "some");
  f.old_key("speed", "rate_hz");
}

Result<MadeConfig> read_made(const std::string& toml) {
  CANYON_TRY(const ConfigNode node, ConfigNode::parse(toml, "dir/made.toml"));
  MadeConfig config;
  CANYON_TRY_STATUS(read_config(&node, "", config));
  return config;
}

/// Every kind of field as it stands in a file; paths from the folder of that file.
StressFigure fields_read() {
  const auto c = read_made(
      "rate_hz = 20\nmust_db = 0\ncount = 9\non = true\ntext = \"b\"\nfile = \"x/../y.csv\"\nfiles = [\"p\", \"/q\"]\n"
      "texts = [\"u\", \"v\"]\nkind = \"blue\"\nkinds = [\"blue\", \"red\"]\nlist = [3]\narm_m = [-9, 0.5, 9]\n"
      "limit_deg = 90\n[group]\nsize_m = 1e-3\n[[items]]\nname = \"one\"\n[[items]]\nsize_m = 7\n");
  if (!c.ok()) return {stress::kInfinity, 0.0};
  int wrong = 0;
  const auto is = [&](bool holds) { wrong += holds ? 0 : 1; };
  is(c->rate_hz == 20.0 && c->must_db == 0.0 && c->count == 9 && c->on && c->text == "b" && c->file == "dir/y.csv");
  is(c->files == std::vector<std::string>{"dir/p", "/q"} && c->texts == std::vector<std::string>{"u", "v"});
  is(c->kind == "blue" && c->kinds == std::vector<std::string>{"blue", "red"} && c->list == std::vector<double>{3.0});
  is(c->arm_m == Eigen::Vector3d(-9.0, 0.5, 9.0) && c->limit_deg == 90.0 && c->group.size_m == 1e-3);
  is(c->group.name == "it" && c->items.size() == 2 && c->items[0].name == "one" && c->items[0].size_m == 2.0);
  is(c->items[1].size_m == 7.0 && c->items[1].name == "it");
  const auto other = read_made("must_db = 1.5\nfile = \"other\"\nkinds = \"green\"\nlimit_deg = -1\n");
  is(other.ok() && other->file == "other" && other->kinds == std::vector<std::string>{"green"} && !other->limit_deg);
  is(other.ok() && other->rate_hz == 5.0 && other->items.empty());
  // A second file over the first, and options over both: tables key by key, lists whole.
  auto base = *ConfigNode::parse("a = 1\n[t]\nx = 1\ny = [1, 2]\n", "base");
  base.overlay(*ConfigNode::parse("[t]\ny = [3]\nz = 4\n", "over"));
  base.set("t.w.v", ConfigNode::of(2.5), "--set");
  base.set("a", ConfigNode::of(std::string("s")), "--set");
  is(base.find("t.x")->describe() == "integer 1" && base.find("t.x")->file_ == "base" && base.find("t.x")->line_ == 3);
  is(base.find("t.y")->describe() == "array of 1" && base.find("t.y")->file_ == "over" && base.find("t.y")->line_ == 2);
  is(base.find("t.w.v")->describe() == "float 2.5" &&
     base.find("t.w.v")->error("k", "w", "e").str() == "--set: k: w, expected e");
  is(base.find("a")->describe() == "string \"s\"" && base.find("t")->describe() == "a table");
  is(!base.find("t.q") && !base.find("a.b") && ConfigNode().describe() == "nothing");
  is(ConfigNode::of(true).describe() == "boolean true" && ConfigNode::of(false).describe() == "boolean false");
  base.erase("a"), is(!base.find("a") && base.find("t"));
  is(ConfigNode::parse("d = 2010-07-01T13:00:00Z\n", "f")->find("d")->describe() == "string \"2010-07-01T13:00:00Z\"");
  return {1.0 * wrong, 0.0};
}

/// Each mistake by its own words; of several the topmost, and what is missing last.
StressFigure mistakes_of_fields() {
  int wrong = 0;
  const auto told = [&](const std::string& toml, const std::string& words) {
    const auto found = read_made(toml);
    wrong += !found.ok() && found.error().str() == "dir/made.toml" + words ? 0 : 1;
  };
  const std::string must = "must_db = 1\n";
  told("", ": must_db: is missing, expected a number of 0 or more");
  told("rate_hz = 0.05\n", ":1: rate_hz: 0.05 is out of range, expected a number from 0.1 to 20");
  told(must + "rate_hz = 21\n", ":2: rate_hz: 21 is out of range, expected a number from 0.1 to 20");
  told(must + "rate_hz = nan\n", ":2: rate_hz: nan is not a finite number, expected a number from 0.1 to 20");
  told(must + "rate_hz = \"5\"\n", ":2: rate_hz: found string \"5\", expected a number from 0.1 to 20");
  told("must_db = -0.1\n", ":1: must_db: -0.1 is out of range, expected a number of 0 or more");
  told(must + "count = 10\n", ":2: count: 10 is out of range, expected a whole number from 0 to 9");
  told(must + "count = -1\n", ":2: count: -1 is out of range, expected a whole number from 0 to 9");
  told(must + "count = 1.5\n", ":2: count: found float 1.5, expected a whole number from 0 to 9");
  told(must + "on = 1\n", ":2: on: found integer 1, expected true or false");
  told(must + "text = true\n", ":2: text: found boolean true, expected a string");
  told(must + "files = \"one\"\n", ":2: files: found string \"one\", expected a list of strings");
  told(must + "texts = [\n\"a\",\n2]\n", ":4: texts[2]: found integer 2, expected a string");
  told(must + "kind = \"gren\"\n",
       ":2: kind: unknown name \"gren\", expected one of \"red\", \"green\", \"blue\"; nearest is \"green\"");
  told(must + "kind = \"violet\"\n", ":2: kind: unknown name \"violet\", expected one of \"red\", \"green\", \"blue\"");
  told(must + "kind = 3\n", ":2: kind: found integer 3, expected one of \"red\", \"green\", \"blue\"");
  told(must + "kinds = [\"red\", \"red\"]\n",
       ":2: kinds: \"red\" stands there twice, expected a list out of \"red\", \"green\", \"blue\"");
  told(must + "kinds = [3]\n", ":2: kinds: found integer 3, expected a list out of \"red\", \"green\", \"blue\"");
  told(must + "[group]\nweight = 1\n", ":3: group.weight: is a key of an earlier version, expected size_m");
  told(must + "list = 3\n", ":2: list: found integer 3, expected a list of numbers");
  told(must + "arm_m = [1, 2]\n", ":2: arm_m: found array of 2, expected a list of 3 numbers");
  told(must + "arm_m = [1, 9.5, 2]\n", ":2: arm_m[2]: 9.5 is out of range, expected a number from -9 to 9");
  told(must + "limit_deg = 91\n", ":2: limit_deg: 91 is out of range, expected a number from 0 to 90, or -1");
  told(must + "group = 3\n", ":2: group: found integer 3, expected a table");
  told(must + "[group]\nsize_m = 0\n", ":3: group.size_m: 0 is out of range, expected a positive number");
  told(must + "items = 3\n", ":2: items: found integer 3, expected a list of tables");
  told(must + "[[items]]\n[[items]]\nsize = 1\n",
       ":4: items[2].size: unknown key, expected one of the documented keys; nearest is \"size_m\"");
  told(must + "[[items]]\nzzz = 1\n",
       ":3: items[1].zzz: unknown key, expected one of the documented keys: \"size_m\", \"name\"");
  told(must + "qqqq = 1\n", ":2: qqqq: unknown key, expected one of the 15 documented keys");
  told(must + "rate_h = 1\n", ":2: rate_h: unknown key, expected one of the documented keys; nearest is \"rate_hz\"");
  told(must + "speed = 1\n", ":2: speed: is a key of an earlier version, expected rate_hz");
  told("on = 2\nrate_hz = 99\n", ":1: on: found integer 2, expected true or false");
  const auto broken = read_made("rate_hz = 1\nrate_hz\n");
  wrong += !broken.ok() && broken.error().str().starts_with("dir/made.toml:2: not valid TOML: ") ? 0 : 1;
  return {1.0 * wrong, 0.0};
}

/// As JSON, as documentation, and the files that it names.
StressFigure fields_written() {
  int wrong = 0;
  const auto is = [&](bool holds) { wrong += holds ? 0 : 1; };
  MadeConfig c;
  c.must_db = 0.1, c.items.resize(1), c.files = {"p"}, c.file = "q.csv";
  const auto visit_fields = [&](FieldVisitor& f) { visit(f, c); };
  is(fields_as_json(visit_fields) ==
     "{\"rate_hz\":5.0,\"must_db\":0.1,\"count\":3,\"on\":false,\"text\":\"a\",\"file\":\"q.csv\",\"files\":[\"p\"],"
     "\"texts\":[],\"kind\":\"red\",\"kinds\":[\"red\"],\"list\":[1.0,2.0],\"arm_m\":[1.0,2.0,3.0],\"limit_deg\":-1.0,"
     "\"group\":{\"size_m\":2.0,\"name\":\"it\"},\"items\":[{\"size_m\":2.0,\"name\":\"it\"}]}");
  const auto files = named_files(visit_fields);
  is(files.size() == 2 && files[0].key == "file" && files[0].path == "q.csv" && files[1].key == "files");
  c.file = "built_in", is(named_files(visit_fields).size() == 1);
  MadeConfig as_it_comes;
  const auto docs = documented_fields("top", [&](FieldVisitor& f) { visit(f, as_it_comes); });
  const char* const rows[][5] = {
      {"top.rate_hz", "Hz", "5", "a number from 0.1 to 20", "how often"},
      {"top.must_db", "dB", "required", "a number of 0 or more", "has to be there"},
      {"top.count", "", "3", "a whole number from 0 to 9", "how many"},
      {"top.on", "", "false", "true or false", "whether"},
      {"top.text", "", "\"a\"", "a string", "any"},
      {"top.file", "", "\"built_in\"", "a name, or a path that ends in .csv", "from where"},
      {"top.files", "", "[]", "a list of paths", "from where"},
      {"top.texts", "", "[]", "a list of strings", "any"},
      {"top.kind", "", "\"red\"", "one of \"red\", \"green\", \"blue\"", "which"},
      {"top.kinds", "", "[\"red\"]", "a list out of \"red\", \"green\", \"blue\"", "which"},
      {"top.list", "", "[1, 2]", "a list of numbers, each a number", "some"},
      {"top.arm_m", "m", "[1, 2, 3]", "a list of 3 numbers, each a number from -9 to 9", "where"},
      {"top.limit_deg", "deg", "-1", "a number from 0 to 90, or -1", "how far"},
      {"top.group.size_m", "m", "2", "a positive number", "how large"},
      {"top.group.name", "", "\"it\"", "a string", "what it is"},
      {"top.items", "", "0 items", "a list of tables", "some"},
      {"top.items[].size_m", "m", "2", "a positive number", "how large"},
      {"top.items[].name", "", "\"it\"", "a string", "what it is"}};
  is(docs.size() == sizeof rows / sizeof rows[0] && as_it_comes.items.empty());
  for (std::size_t i = 0; i < docs.size() && i < sizeof rows / sizeof rows[0]; ++i)
    is(docs[i].key == rows[i][0] && docs[i].unit == rows[i][1] && docs[i].default_value == rows[i][2] &&
       docs[i].range == rows[i][3] && docs[i].meaning == rows[i][4]);
  is(range_text({-kAnyNumber.max, 4.0}, true) == "a whole number of 4 or less" &&
     range_text(kAnyNumber, false) == "a number");
  is(plain_list({"a", "b"}) == "a, b" && quoted_list({"a", "b"}) == "\"a\", \"b\"" && quoted_list({}).empty());
  const std::vector<std::string> words{"rate_hz", "range_m", "window", "win"};
  is(nearest_word("rate_zh", words) == "rate_hz" && nearest_word("rnge_m", words) == "range_m");
  is(nearest_word("windows_of_it", words) == "window" && nearest_word("xyz", words).empty() &&
     nearest_word("wi", words) == "win");
  return {1.0 * wrong, 0.0};
}

}  // namespace

std::vector<StressCase> configuration_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "fields of a configuration, and mistakes in it",
           "an end of a range that is left out, a line of another key, a default that stays where something stands",
           "every kind of field written out; each mistake word by word, with file, line and key: exact", "wrong"});
  rows.add("configurations/fields_read", fields_read)
      .add("configurations/mistakes", mistakes_of_fields)
      .add("configurations/fields_written", fields_written);
  return rows.take();
}

}  // namespace canyon
