#include "canyon/core/files/row_store.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "canyon/core/files/file_hash.h"
#include "canyon/core/files/file_writer.h"
#include "canyon/core/files/files.h"
#include "canyon/core/random/random.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon {
namespace {

struct Row {
  double value;
  std::int64_t k;
};

// Three blocks and a half: most of it is read back from the file.
constexpr std::size_t kRows = 7 * ByteStore::kBlock / sizeof(Row) / 2;

TEST(RowStore, GivesBackItsRowsInTheirOrder) {
  const testing::TemporaryFolder folder;
  RowStore<Row> rows(folder.path().string());
  for (std::size_t k = 0; k < kRows; ++k)
    ASSERT_TRUE(rows.append({0.5 * static_cast<double>(k), static_cast<std::int64_t>(k)}).ok());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "the file has no name";
  ASSERT_EQ(rows.size(), kRows);
  std::int64_t next = 0;
  ASSERT_TRUE(rows.for_each([&](const Row& row) {
                    ASSERT_EQ(row.k, next);
                    ASSERT_EQ(row.value, 0.5 * static_cast<double>(next++));
                  })
                  .ok());
  EXPECT_EQ(next, static_cast<std::int64_t>(kRows));
}

TEST(RowStore, RanksAreThoseOfSorting) {
  const RandomStream stream(1, "test.row_store");
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{100}, kRows}) {
    RowStore<Row> rows(::testing::TempDir());
    std::vector<double> sorted;
    for (std::size_t k = 0; k < count; ++k) {
      // Over many powers of two, with zeros and equal values among them.
      const double value = k % 7 == 0 ? 0.0 : std::abs(std::exp(10.0 * stream.normal(0, k / 2)));
      sorted.push_back(value);
      ASSERT_TRUE(rows.append({value, 0}).ok());
    }
    std::sort(sorted.begin(), sorted.end());
    for (const std::size_t k : {std::size_t{0}, count / 3, count / 2, count - 1})
      EXPECT_EQ(*rows.ranked(k, [](const Row& row) { return row.value; }), sorted[k]) << k << " of " << count;
  }
}

TEST(RowStore, SaysWhereItsFileCannotBe) {
  RowStore<Row> rows("/nowhere");
  Status status = Ok{};
  for (std::size_t k = 0; k < kRows && status.ok(); ++k) status = rows.append({});
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().exit_code, 1);
  EXPECT_EQ(
      status.error().str(),
      "/nowhere: a temporary file cannot be made (No such file or directory), expected space for what a run keeps "
      "until its end");
}

TEST(FileWriter, WritesPieceByPieceAndTheHashIsThatOfTheWhole) {
  const testing::TemporaryFolder folder;
  std::string all;
  auto out = FileWriter::create(folder.file("a"));
  ASSERT_TRUE(out.ok());
  for (int i = 0; i < 30000; ++i) {
    const std::string piece = std::to_string(i) + "\n";
    ASSERT_TRUE(out->write(piece).ok());
    all += piece;
  }
  ASSERT_TRUE(out->close().ok());
  EXPECT_EQ(*read_text_file(folder.file("a")), all);
  EXPECT_EQ(*sha256_of_file(folder.file("a")), sha256_hex(all));
  EXPECT_FALSE(sha256_of_file(folder.file("b")).ok());
  EXPECT_FALSE(FileWriter::create(folder.file("none/a")).ok());
}

}  // namespace
}  // namespace canyon
