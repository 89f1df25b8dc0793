#include "canyon/gnss/rinex/reader_warnings.h"

namespace canyon::gnss {
namespace {

constexpr std::size_t kListed = 20;

}  // namespace

void ReaderWarnings::add(int line, std::string what, std::string expected) {
  ++count_;
  if (first_.size() < kListed)
    first_.push_back(Error{file_, line, "", std::move(what), std::move(expected)}.str() + "; skipped");
}

void ReaderWarnings::note(int line, std::string what) {
  ++count_;
  if (first_.size() < kListed) first_.push_back(Error{file_, line, "", std::move(what)}.str());
}

std::vector<std::string> ReaderWarnings::list() const {
  auto out = first_;
  if (static_cast<std::size_t>(count_) > kListed)
    out.push_back(file_ + ": " + std::to_string(static_cast<std::size_t>(count_) - kListed) + " more " + noun_ +
                  " were skipped");
  return out;
}

}  // namespace canyon::gnss
