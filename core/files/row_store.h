#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "canyon/core/check.h"
#include "canyon/core/result.h"

namespace canyon {

/// Bytes in the order they came: the last block in memory, those before it in a file without a name, which goes when
/// its owner goes, however the program ends. Few bytes never touch the disk.
class ByteStore {
 public:
  /// The file, if there must be one, is made in this directory; in the system's for temporary files if it is empty.
  explicit ByteStore(std::string directory) : directory_(std::move(directory)) {}
  ~ByteStore();
  ByteStore(const ByteStore&) = delete;
  ByteStore& operator=(const ByteStore&) = delete;

  static constexpr std::size_t kBlock = std::size_t{1} << 16;
  /// Errors (exit 1) where the file cannot be made or the disk is full.
  Status append(const void* bytes, std::size_t size);
  std::size_t size() const { return in_file_ + block_.size(); }
  /// The next up to kBlock bytes from `at`; none at the end.
  Status read(std::size_t at, std::vector<char>& out) const;

 private:
  Status spill();
  std::string directory_;
  std::vector<char> block_;
  std::size_t in_file_ = 0;
  int descriptor_ = -1;
};

/// Rows of plain numbers, however many: what needs them again after a long run reads them back.
template <class Row>
class RowStore {
  static_assert(std::is_trivially_copyable_v<Row> && ByteStore::kBlock % sizeof(Row) == 0);

 public:
  explicit RowStore(const std::string& directory) : bytes_(directory) {}

  Status append(const Row& row) { return bytes_.append(&row, sizeof row); }
  std::size_t size() const { return bytes_.size() / sizeof(Row); }

  /// Goes through the rows in their order.
  class Reader {
   public:
    explicit Reader(const RowStore& rows) : rows_(rows) {}
    /// The next row; none after the last.
    Result<std::optional<Row>> next() {
      if (i_ == block_.size()) {
        CANYON_TRY_STATUS(rows_.bytes_.read(at_, block_));
        at_ += block_.size();
        i_ = 0;
        if (block_.empty()) return std::optional<Row>();
      }
      Row row;
      std::memcpy(&row, &block_[i_], sizeof row);
      i_ += sizeof row;
      return std::optional<Row>(row);
    }

   private:
    const RowStore& rows_;
    std::vector<char> block_;
    std::size_t at_ = 0, i_ = 0;
  };

  template <class Visit>
  Status for_each(const Visit& visit) const {
    for (Reader reader(*this);;) {
      CANYON_TRY(const std::optional<Row> row, reader.next());
      if (!row) return Ok{};
      visit(*row);
    }
  }

  /// The k-th smallest (k from 0) of value(row), exactly, without holding them: its bits are found byte by byte from
  /// the highest. Values must not be negative (throws): only then do bits, as integers, have the order of the numbers.
  template <class Value>
  Result<double> ranked(std::size_t k, const Value& value) const {
    CANYON_CHECK(k < size(), k, " of ", size());
    std::uint64_t found = 0;
    for (int shift = 56; shift >= 0; shift -= 8) {
      std::size_t counts[256] = {};
      CANYON_TRY_STATUS(for_each([&](const Row& row) {
        const auto x = static_cast<double>(value(row));
        CANYON_CHECK(!std::signbit(x), x);
        const auto bits = std::bit_cast<std::uint64_t>(x);
        if (shift == 56 || bits >> (shift + 8) == found >> (shift + 8)) ++counts[bits >> shift & 255];
      }));
      std::uint64_t byte = 0;
      for (; k >= counts[byte]; ++byte) k -= counts[byte];
      found |= byte << shift;
    }
    return std::bit_cast<double>(found);
  }

 private:
  ByteStore bytes_;
};

}  // namespace canyon
