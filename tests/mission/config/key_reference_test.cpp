#include "canyon/mission/config/key_reference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "canyon/core/files/files.h"

namespace canyon::mission {
namespace {

using ::testing::HasSubstr;

TEST(KeyReference, TheCommittedPageIsWhatTheBinaryWrites) {
  const auto page = read_text_file(std::string(CANYON_SOURCE_DIR) + "/docs/mission.md");
  ASSERT_TRUE(page.ok()) << page.error().str();
  EXPECT_TRUE(*page == key_reference()) << "run: canyon keys > docs/mission.md";
}

TEST(KeyReference, SaysWhatThereIsToSayOfAKey) {
  const std::string page = key_reference();
  EXPECT_THAT(page, HasSubstr("\n## [vehicle]: the ground vehicle\n"));
  EXPECT_THAT(page, HasSubstr("| `max_speed_m_s` | m/s | 6 | a number from 0.1 to 30 | limit |\n"));
  EXPECT_THAT(page, HasSubstr("| `waypoint[].p_m` | m | required | a list of 2 numbers, each a number from -1e+05 to "
                              "1e+05 | x and y in W, metres east and north of the scene's centre |\n"));
  EXPECT_THAT(page, HasSubstr("| `method` |  | \"gicp\" | one of \"none\", "));
}

}  // namespace
}  // namespace canyon::mission
