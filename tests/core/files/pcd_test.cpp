#include "canyon/core/files/pcd.h"

#include <array>
#include <cstring>

#include <gtest/gtest.h>

#include "canyon/core/files/files.h"
#include "canyon/core/random/random.h"
#include "canyon/tests/support/temporary_folder.h"

namespace canyon {
namespace {

using Places = std::vector<std::array<float, 3>>;

/// x, y and z of every point.
Result<Places> read_places_of(const std::string& path) {
  CANYON_TRY(PcdReader reader, PcdReader::open(path));
  CANYON_TRY(const std::size_t x, reader.float_at("x"));
  CANYON_TRY(const std::size_t y, reader.float_at("y"));
  CANYON_TRY(const std::size_t z, reader.float_at("z"));
  Places out;
  for (;;) {
    CANYON_TRY(const auto bytes, reader.next());
    if (bytes.empty()) return out;
    for (std::size_t at = 0; at < bytes.size(); at += reader.point_bytes()) {
      out.emplace_back();
      for (std::size_t k = 0; const std::size_t field : {x, y, z})
        std::memcpy(&out.back()[k++], bytes.data() + at + field, sizeof(float));
    }
  }
}

class Pcd : public ::testing::Test {
 protected:
  std::string path_ = canyon::testing::temporary_file("test.pcd");
  std::string error_of(const std::string& content) {
    EXPECT_TRUE(write_text_file(path_, content).ok());
    const auto cloud = read_places_of(path_);
    if (cloud.ok()) return "no error";
    const std::string text = cloud.error().str();
    return text.starts_with(path_) ? text.substr(path_.size()) : text;
  }
  /// Points i, 2 i, 3 i.
  static std::string cloud(std::size_t points) {
    std::string out = pcd_header({{.name = "x"}, {.name = "y"}, {.name = "z"}}, points);
    for (std::size_t i = 0; i < points; ++i)
      for (const float factor : {1.0f, 2.0f, 3.0f}) {
        const float value = factor * static_cast<float>(i);
        out.append(reinterpret_cast<const char*>(&value), sizeof value);
      }
    return out;
  }
};

TEST_F(Pcd, HeaderSaysWhatFollows) {
  EXPECT_EQ(pcd_header({{.name = "x"}, {.name = "ring", .type = 'U', .size = 2, .count = 3}}, 7),
            "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x ring\nSIZE 4 2\nTYPE F U\nCOUNT 1 3\n"
            "WIDTH 7\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 7\nDATA binary\n");
}

// 200,000 points of 12 bytes come in three pieces.
TEST_F(Pcd, WhatIsWrittenIsReadBackPieceByPiece) {
  ASSERT_TRUE(write_text_file(path_, cloud(200'000) + "what stands behind is passed over").ok());
  const auto back = read_places_of(path_);
  ASSERT_TRUE(back.ok()) << back.error().str();
  ASSERT_EQ(back->size(), 200'000u);
  for (std::size_t i = 0; i < back->size(); ++i) {
    const auto x = static_cast<float>(i);
    ASSERT_EQ((*back)[i], (std::array{x, 2.0f * x, 3.0f * x}));
  }
}

TEST_F(Pcd, EmptyCloud) {
  ASSERT_TRUE(write_text_file(path_, cloud(0)).ok());
  const auto back = read_places_of(path_);
  ASSERT_TRUE(back.ok()) << back.error().str();
  EXPECT_TRUE(back->empty());
}

TEST_F(Pcd, OtherFieldsAndOrdersAreRead) {
  const float values[2][6] = {{9, 3, 1, 2, 0.5f, 7}, {9, 6, 4, 5, 0.25f, 7}};
  const std::string head =
      "VERSION 0.7\nFIELDS rgb z x y intensity normal\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\nCOUNT 1 1 1 1 1 1\n"
      "WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA binary\n";
  ASSERT_TRUE(write_text_file(path_, head + std::string(reinterpret_cast<const char*>(values), sizeof values)).ok());
  const auto cloud = read_places_of(path_);
  ASSERT_TRUE(cloud.ok()) << cloud.error().str();
  EXPECT_EQ((*cloud)[1], (std::array{4.0f, 5.0f, 6.0f}));
}

TEST_F(Pcd, MistakesAreNamed) {
  const std::string head = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  EXPECT_EQ(error_of(""), ":1: the header ends early, expected DATA binary");
  EXPECT_EQ(error_of(head), ":6: the header ends early, expected DATA binary");
  EXPECT_EQ(error_of(head + "DATA binary\n"), ":6: DATA: \"DATA binary\", expected POINTS N before it");
  EXPECT_EQ(error_of(head + "POINTS two\n"), ":6: POINTS: \"POINTS two\", expected POINTS N");
  EXPECT_EQ(error_of(head + "POINTS 2\nDATA ascii\n"), ":7: DATA: \"DATA ascii\", expected DATA binary");
  EXPECT_EQ(error_of(head + "POINTS 2\nDATA binary\n0123456789ab"),
            ": POINTS: the file holds 1 points, expected 2 as its header says");
  EXPECT_EQ(error_of(head + "POINTS 99999999999999999\nDATA binary\n"),
            ": POINTS: the file holds 0 points, expected 99999999999999999 as its header says");
  EXPECT_EQ(error_of("FIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nPOINTS 0\nDATA binary\n"),
            ": z: no such field, expected one of type F, size 4 and count 1");
  EXPECT_EQ(error_of("FIELDS x y z\nSIZE 4 -4 4\n"),
            ":2: SIZE: \"SIZE 4 -4 4\", expected 1, 2, 4 or 8 bytes for each field");
  EXPECT_EQ(error_of("FIELDS x y z\nSIZE 4 4\n"), ":2: SIZE: \"SIZE 4 4\", expected one value per field");
  EXPECT_FALSE(read_places_of("no_such_file.pcd").ok());
}

// 2026-11-22: every COUNT line multiplied the fields' sizes, so that seven of them made a stride of 0 (division by
// zero) or one that lay beyond the data (segmentation fault).
TEST_F(Pcd, NoEntryComesTwice) {
  const std::string head = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";
  const std::string count = "COUNT 1024 1024 1024\n";
  std::string counts;
  for (int i = 0; i < 7; ++i) counts += count;
  EXPECT_EQ(error_of(head + counts + "POINTS 1\nDATA binary\n0123456789abcdef"),
            ":5: COUNT: \"COUNT 1024 1024 1024\", expected each entry once");
  // Two fields of 2^63 bytes: the stride wraps to 12, and x lies at 2^63.
  std::string wrap = "FIELDS a x y z b\nSIZE 4 4 4 4 4\nTYPE F F F F F\n";
  for (int i = 0; i < 6; ++i) wrap += "COUNT 1024 1 1 1 1024\n";
  EXPECT_EQ(error_of(wrap + "COUNT 2 1 1 1 2\nPOINTS 1\nDATA binary\n0123456789ab"),
            ":5: COUNT: \"COUNT 1024 1 1 1 1024\", expected each entry once");
  EXPECT_EQ(error_of(head + "SIZE 8 8 8\n"), ":4: SIZE: \"SIZE 8 8 8\", expected each entry once");
  EXPECT_EQ(error_of(head + "FIELDS x\n"), ":4: FIELDS: \"FIELDS x\", expected each entry once");
}

// 2026-11-22: SIZE, TYPE and COUNT without values, before FIELDS, agreed with no fields: a stride of 0.
TEST_F(Pcd, WhatGoesByFieldComesAfterTheFields) {
  for (const char* entry : {"SIZE", "TYPE", "COUNT"})
    EXPECT_EQ(
        error_of(std::string(entry) + "\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA binary\n0123456789ab"),
        std::string(":1: ") + entry + ": \"" + entry + "\", expected FIELDS before it");
}

// 2026-11-22: a header without fields made a stride of 0; sizes, types and shapes were not looked at.
TEST_F(Pcd, DamagedHeadersAreNamed) {
  const std::string head = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";
  EXPECT_EQ(error_of("POINTS 1\nDATA binary\n0123456789ab"), ":2: DATA: \"DATA binary\", expected FIELDS before it");
  EXPECT_EQ(error_of("FIELDS\n"), ":1: FIELDS: \"FIELDS\", expected names of fields");
  EXPECT_EQ(error_of("FIELDS x y z\nPOINTS 1\nDATA binary\n0123456789ab"),
            ":3: DATA: \"DATA binary\", expected SIZE before it");
  EXPECT_EQ(error_of("SIZE 4\n"), ":1: SIZE: \"SIZE 4\", expected FIELDS before it");
  EXPECT_EQ(error_of("FIELDS x y z\nSIZE 4 3 4\n"),
            ":2: SIZE: \"SIZE 4 3 4\", expected 1, 2, 4 or 8 bytes for each field");
  EXPECT_EQ(error_of("FIELDS x y z\nTYPE F FF F\n"), ":2: TYPE: \"TYPE F FF F\", expected F, I or U for each field");
  EXPECT_EQ(error_of(head + "COUNT 1 1 70000\n"),
            ":4: COUNT: \"COUNT 1 1 70000\", expected whole numbers from 1 to 65536");
  EXPECT_EQ(error_of(head + "COUNT 1 0 1\n"), ":4: COUNT: \"COUNT 1 0 1\", expected whole numbers from 1 to 65536");
  EXPECT_EQ(error_of(head + "COUNT 1 1 2\nPOINTS 0\nDATA binary\n"),
            ": z: no such field, expected one of type F, size 4 and count 1");
  EXPECT_EQ(error_of(head + "WIDTH 2\nHEIGHT 3\nPOINTS 5\nDATA binary\n"),
            ":7: DATA: \"DATA binary\", expected WIDTH times HEIGHT to be POINTS");
  EXPECT_EQ(
      error_of(head + "WIDTH 18446744073709551615\nHEIGHT 18446744073709551615\nPOINTS 1\nDATA binary\n0123456789ab"),
      ":7: DATA: \"DATA binary\", expected WIDTH times HEIGHT to be POINTS");
  EXPECT_EQ(error_of(head + "WIDTH 18446744073709551616\n"),
            ":4: WIDTH: \"WIDTH 18446744073709551616\", expected WIDTH N");
  EXPECT_EQ(error_of(head + "POINTS 1\nDATA binary_compressed\n0123456789ab"),
            ":5: DATA: \"DATA binary_compressed\", expected DATA binary");
  EXPECT_EQ(error_of("FIELDS x x y z\nSIZE 4 4 4 4\nTYPE F F F F\nPOINTS 0\nDATA binary\n"),
            ": x: there are two such fields, expected one");
  EXPECT_EQ(error_of("\x01\xff junk\n"),
            ":1: ??: \"?? junk\", expected one of VERSION, FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, VIEWPOINT, "
            "POINTS, DATA");
}

// Bits, cuts, huge numbers and repeated lines, seeded: an error or a cloud, no exception, no signal.
TEST_F(Pcd, DamagedFilesEndInAnErrorOrACloud) {
  const std::string good = cloud(40);
  const std::size_t header = good.find("DATA binary\n") + 12;
  const RandomStream random(12, "test.damage");
  int read = 0;
  for (std::uint32_t variant = 0; variant < 2000; ++variant) {
    std::uint64_t n = 0;
    const auto below = [&](std::size_t end) {
      return static_cast<std::size_t>(random.uniform(variant, n++) * static_cast<double>(end));
    };
    std::string bytes = good;
    if (variant % 4 == 0) {
      for (int k = 0; k < 3; ++k) bytes[below(header)] ^= static_cast<char>(1u << below(8));
    } else if (variant % 4 == 1) {
      bytes.resize(below(bytes.size()));
    } else if (variant % 4 == 2) {
      const char* const numbers[] = {"0", "-1", "1024", "65536", "4294967296", "18446744073709551615", "1e9", "nan"};
      const std::size_t at = bytes.find_first_of("0123456789", 60 + below(header - 80));
      bytes.replace(at, 1, numbers[below(8)]);
    } else {
      if (variant % 8 == 3) bytes.replace(bytes.find("COUNT 1 1"), 9, "COUNT 1024 1024");
      const std::size_t begin = bytes.rfind('\n', below(header - 2)) + 1, end = bytes.find('\n', begin) + 1;
      const std::string line = bytes.substr(begin, end - begin);
      for (std::size_t k = 0, count = 1 + below(12); k < count; ++k) bytes.insert(begin, line);
    }
    ASSERT_TRUE(write_text_file(path_, bytes).ok());
    const auto damaged = read_places_of(path_);
    read += damaged.ok() ? 1 : 0;
    if (!damaged.ok()) {
      ASSERT_EQ(damaged.error().str().find('\n'), std::string::npos) << variant;
    }
  }
  EXPECT_GT(read, 0);
  EXPECT_LT(read, 2000);
}

}  // namespace
}  // namespace canyon
