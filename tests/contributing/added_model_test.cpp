// "To add a model" of docs/design.md, done: what a new model with three keys touches.
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/messages.h"
#include "canyon/core/units.h"
#include "canyon/gnss/atmosphere/ionosphere.h"

namespace canyon::gnss {

// In the product these two lines stand in ionosphere.h, and the row at the foot of the table in ionosphere.cpp.
Result<std::unique_ptr<IonosphereModel>> make_diurnal(const ModelParameters& own, const IonosphereSetup& at);
void diurnal_parameters(ModelParameters& section);

namespace {

ModelTable<MakeIonosphere> with_the_new_one() {
  static const std::vector<ModelRow<MakeIonosphere>> rows = [] {
    const auto known = ionosphere_models();
    std::vector<ModelRow<MakeIonosphere>> all(known.begin(), known.end());
    all.push_back({"diurnal", make_diurnal, "half a cosine over the day", diurnal_parameters});
    return all;
  }();
  return rows;
}

/// As GnssConfig has it: one member and one line of visit(), whatever the table holds.
template <auto Rows>
struct Section {
  ModelChoice<Rows> ionosphere{"single_layer"};
};
template <auto Rows>
void visit(FieldVisitor& f, Section<Rows>& c) {
  visit_choice(f, "ionosphere", c.ionosphere, "ionospheric delay");
}
using Before = Section<ionosphere_models>;
using After = Section<with_the_new_one>;

template <class S>
Result<S> read(const std::string& toml) {
  CANYON_TRY(const ConfigNode node, ConfigNode::parse(toml, "my.toml"));
  S section;
  CANYON_TRY_STATUS(read_config(&node, "gnss", section));
  return section;
}

template <class S>
std::vector<FieldDoc> documented() {
  S section;
  return documented_fields("", [&](FieldVisitor& f) { visit(f, section); });
}

// 14 h local solar time on the meridian of Greenwich: overhead the content of the day, nothing else.
double overhead_m(const After& section, double hour) {
  const auto model = section.ionosphere.make("gnss.ionosphere", IonosphereSetup{});
  if (!model) return kNaN;
  SkyView view;
  view.t = GpsTime::from_week_sow(1610, 3 * 86400.0 + 3600.0 * hour);
  view.receiver = {};
  view.azimuth_rad = 0.0;
  view.elevation_rad = 0.5 * kPi;
  return (*model)->delay_m(view);
}

TEST(AddedModel, IsReadFromAMissionFileAndRuns) {
  const auto section = read<After>("ionosphere = \"diurnal\"\nnight_tecu = 4\nday_tecu = 40\npeak_hour = 13.5\n");
  ASSERT_TRUE(section.ok()) << section.error().str();
  // Delays are proportional to the content; n eps scale: five roundings.
  EXPECT_NEAR(overhead_m(*section, 13.5), vertical_ionosphere_m(40.0), 5 * 2.3e-16 * vertical_ionosphere_m(40.0));
  EXPECT_NEAR(overhead_m(*section, 2.0), vertical_ionosphere_m(4.0), 5 * 2.3e-16 * vertical_ionosphere_m(4.0));
  EXPECT_THAT(read<Before>("night_tecu = 4").error().str(),
              ::testing::StartsWith("my.toml:1: gnss.night_tecu: unknown key"));
}

TEST(AddedModel, ItsMistakesAreNamed) {
  EXPECT_EQ(read<After>("day_tecu = -1").error().str(),
            "my.toml:1: gnss.day_tecu: -1 is out of range, expected a number from 0 to 500");
  EXPECT_THAT(read<After>("ionosphere = \"diurnel\"").error().str(), ::testing::EndsWith("nearest is \"diurnal\""));
  EXPECT_EQ(read<After>("ionosphere = \"diurnal\"\nday_tecu = 1")
                ->ionosphere.make("gnss.ionosphere", IonosphereSetup{})
                .error()
                .str(),
            "gnss.day_tecu: is below gnss.night_tecu, expected a day that is brighter than the night");
}

TEST(AddedModel, IsInTheManifest) {
  auto section = *read<After>("ionosphere = \"diurnal\"\nday_tecu = 40\n");
  EXPECT_EQ(
      fields_as_json([&](FieldVisitor& f) { visit(f, section); }),
      R"({"ionosphere":"diurnal","vtec_tecu":12.0,"ionex_file":"","night_tecu":5.0,"day_tecu":40.0,"peak_hour":14.0})");
  // A copy is a value of its own.
  After copy = section;
  copy.ionosphere.own.get<ElectronContent>().vtec_tecu = 99.0;
  EXPECT_EQ(section.ionosphere.own.get<ElectronContent>().vtec_tecu, 12.0);
}

// The count: of the documentation three keys more and one list of names longer. Beside the row nothing was touched.
TEST(AddedModel, AddsItsThreeKeysAndNothingElse) {
  EXPECT_EQ(with_the_new_one().size(), ionosphere_models().size() + 1);
  std::vector<std::string> added, changed;
  const auto before = documented<Before>();
  for (const FieldDoc& now : documented<After>()) {
    const auto was = std::find_if(before.begin(), before.end(), [&](const FieldDoc& d) { return d.key == now.key; });
    if (was == before.end())
      added.push_back(now.key);
    else if (was->range != now.range || was->default_value != now.default_value || was->meaning != now.meaning)
      changed.push_back(now.key);
  }
  EXPECT_THAT(added, ::testing::ElementsAre("night_tecu", "day_tecu", "peak_hour"));
  EXPECT_THAT(changed, ::testing::ElementsAre("ionosphere"));
}

}  // namespace
}  // namespace canyon::gnss
