#pragma once

#include <string>
#include <vector>

#include "canyon/core/result.h"

namespace canyon::gnss {

/// What a reader skipped: the first ones line by line, the others counted.
class ReaderWarnings {
 public:
  /// `noun` names what is counted, in the plural: "damaged records".
  ReaderWarnings(std::string file, std::string noun) : file_(std::move(file)), noun_(std::move(noun)) {}

  void add(int line, std::string what, std::string expected = "");
  /// The same without "; skipped": `what` itself says what was done.
  void note(int line, std::string what);
  int count() const { return count_; }
  /// `file:line: what, expected ...; skipped`, or as noted; at most 20 of them, then one line that counts the rest.
  std::vector<std::string> list() const;

 private:
  std::string file_, noun_;
  int count_ = 0;
  std::vector<std::string> first_;
};

}  // namespace canyon::gnss
