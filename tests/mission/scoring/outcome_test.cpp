#include "canyon/mission/scoring/outcome.h"

#include <string>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"

namespace canyon::mission {
namespace {

// What a reader of results looks up is what the program writes: the page's table is made of the rows, in their order.
TEST(Outcome, TheTableOfTheDocumentationIsTheProgramsOwn) {
  const auto page = read_text_file(CANYON_SOURCE_DIR "/docs/results.md");
  ASSERT_TRUE(page.ok());
  std::string table = "| outcome | when |\n|---|---|\n";
  for (const auto& row : outcomes()) table += std::string("| `") + row.name + "` | " + row.doc + " |\n";
  const std::size_t at = page->find("| outcome | when |");
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(page->substr(at, page->find("\n\n", at) + 1 - at), table);
}

TEST(Outcome, EveryValueHasOneRow) {
  for (int value = 0; value <= static_cast<int>(Outcome::kSuccess); ++value) {
    int rows = 0;
    for (const auto& row : outcomes()) rows += row.make == static_cast<Outcome>(value) ? 1 : 0;
    EXPECT_EQ(rows, 1) << value;
  }
  EXPECT_EQ(outcomes().size(), static_cast<std::size_t>(Outcome::kSuccess) + 1);
}

}  // namespace
}  // namespace canyon::mission
