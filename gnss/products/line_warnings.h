#pragma once

#include <string>
#include <vector>

namespace canyon::gnss {

/// Collects warnings about the lines of one file: the first twenty one by one, of the others their number.
class LineWarnings {
 public:
  explicit LineWarnings(std::string file) : file_(std::move(file)) {}

  void add(int line, const std::string& what) {
    if (++count_ <= kMost) lines_.push_back(file_ + ":" + std::to_string(line) + ": " + what);
  }
  int count() const { return count_; }
  std::vector<std::string> take() {
    if (count_ > kMost)
      lines_.push_back(file_ + ": " + std::to_string(count_ - kMost) + " more damaged lines were skipped");
    return std::move(lines_);
  }

 private:
  static constexpr int kMost = 20;
  std::string file_;
  std::vector<std::string> lines_;
  int count_ = 0;
};

}  // namespace canyon::gnss
