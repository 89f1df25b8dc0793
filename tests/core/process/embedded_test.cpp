#include "canyon/core/process/embedded.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"

namespace canyon {
namespace {

const std::filesystem::path kSourceTree =
#include "embedded/source_folder.inc"
    ;

TEST(Embedded, EveryFileHasTheBytesOfTheSourceTree) {
  for (const std::string_view key : embedded_files("")) {
    const auto bytes = embedded_file(key);
    ASSERT_TRUE(bytes.has_value()) << key;
    const auto file = read_text_file((kSourceTree / key).string());
    ASSERT_TRUE(file.ok()) << file.error().str();
    EXPECT_EQ(*file, *bytes) << key;
  }
}

TEST(Embedded, KeysAreSortedAndFilteredByPrefix) {
  const auto all = embedded_files("");
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  std::size_t in_beams = 0;
  for (const std::string_view key : all) in_beams += key.substr(0, 12) == "lidar/beams/" ? 1 : 0;
  EXPECT_EQ(embedded_files("lidar/beams/").size(), in_beams);
  EXPECT_TRUE(embedded_files("no/such/folder").empty());
}

TEST(Embedded, AMissingKeyIsNothing) {
  EXPECT_FALSE(embedded_file("scene/no_such_file.toml").has_value());
  EXPECT_FALSE(embedded_file("").has_value());
}

}  // namespace
}  // namespace canyon
