#include "canyon/tests/mutation/packed_pcd.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace canyon::testing {

std::string lzf_packed(const std::string& bytes) {
  constexpr std::size_t kLongestRun = 32, kShortestCopy = 3, kLongestCopy = 264, kFarthest = 8192;
  std::string out, run;
  const auto end_run = [&] {
    for (std::size_t at = 0; at < run.size(); at += kLongestRun) {
      const std::string piece = run.substr(at, kLongestRun);
      out += static_cast<char>(piece.size() - 1);
      out += piece;
    }
    run.clear();
  };
  for (std::size_t at = 0; at < bytes.size();) {
    std::size_t longest = 0, back = 0;
    for (std::size_t from = at - std::min(at, kFarthest); from < at; ++from) {
      std::size_t alike = 0;
      while (alike < kLongestCopy && at + alike < bytes.size() && bytes[from + alike] == bytes[at + alike]) ++alike;
      if (alike > longest) longest = alike, back = at - from;
    }
    if (longest < kShortestCopy) {
      run += bytes[at++];
      continue;
    }
    end_run();
    const std::size_t length = longest - 2, offset = back - 1;
    out += static_cast<char>(std::min<std::size_t>(length, 7) << 5 | offset >> 8);
    if (length >= 7) out += static_cast<char>(length - 7);
    out += static_cast<char>(offset & 0xff);
    at += longest;
  }
  end_run();
  return out;
}

std::string packed_pcd(const std::vector<PcdField>& fields, std::size_t points, const std::string& columns) {
  std::string head = pcd_header(fields, points);
  head.replace(head.find("DATA binary"), 11, "DATA binary_compressed");
  const std::string packed = lzf_packed(columns);
  const std::uint32_t lengths[] = {static_cast<std::uint32_t>(packed.size()),
                                   static_cast<std::uint32_t>(columns.size())};
  std::string both(sizeof lengths, '\0');
  std::memcpy(both.data(), lengths, sizeof lengths);
  return head + both + packed;
}

}  // namespace canyon::testing
