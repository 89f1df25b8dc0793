#include "canyon/core/output/staged.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "canyon/core/files/files.h"
#include "canyon/core/output/disk.h"
#include "canyon/core/output/staging_name.h"
#include "canyon/core/process/progress.h"
#include "canyon/core/process/staging_litter.h"

namespace canyon {
namespace {

namespace fs = std::filesystem;

bool exists(const std::string& path) {
  std::error_code code;
  return fs::exists(fs::symlink_status(path, code));
}

Error not_placed(const std::string& path, const std::error_code& code) {
  return Error{path, 0, "", "cannot be put in place (" + code.message() + ")", "a writable directory", 1};
}

}  // namespace

Staged::Staged(std::string final_path, std::string staging, bool force, std::vector<std::string> parents)
    : final_(std::move(final_path)), staging_(std::move(staging)), force_(force), created_parents_(std::move(parents)) {
  if (!staging_.empty()) add_litter(staging_, created_parents_);
}

Staged::Staged(Staged&& other) noexcept
    : final_(std::move(other.final_)),
      staging_(std::exchange(other.staging_, {})),
      force_(other.force_),
      created_parents_(std::exchange(other.created_parents_, {})),
      replaced_(std::exchange(other.replaced_, {})) {}

Staged::~Staged() {
  if (staging_.empty()) return;
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  remove_empty_directories(created_parents_);
  forget_litter(staging_);
}

Status Staged::commit() {
  return commit_together({this});
}

/// Within hold_litter(). What stood there gets the staging name, in one step where the file system can.
Status Staged::place() {
  if (staging_.empty()) return Ok{};
  for (int attempt = 0; attempt < 100; ++attempt) {
    if (!force_ || !exists(final_)) {
      const std::error_code code = rename_to_new(staging_, final_);
      if (!code) return Ok{};
      if (code != std::errc::file_exists) return not_placed(final_, code);
      if (!force_) final_ = next_free_name();
      continue;  // it appeared meanwhile
    }
    CANYON_TRY_STATUS(check_replaced());
    std::error_code code = exchange_names(staging_, final_);
    if (!code) {
      replaced_ = staging_;
      return Ok{};
    }
    if (code != std::errc::not_supported) return not_placed(final_, code);
    const std::string old = staging_name(final_, "replaced").string();
    fs::rename(final_, old, code);
    if (code) return not_placed(final_, code);
    fs::rename(staging_, final_, code);
    if (!code) {
      replaced_ = old;
      return Ok{};
    }
    std::error_code ignored;
    fs::rename(old, final_, ignored);
    return not_placed(final_, code);
  }
  return not_placed(final_, std::make_error_code(std::errc::file_exists));
}

/// Within hold_litter(): undoes place().
void Staged::take_back() {
  if (staging_.empty()) return;
  std::error_code ignored;
  if (replaced_ == staging_) {
    ignored = exchange_names(staging_, final_);
  } else {
    fs::rename(final_, staging_, ignored);
    if (!replaced_.empty()) fs::rename(replaced_, final_, ignored);
  }
  replaced_.clear();
}

/// What was replaced goes.
void Staged::settle() {
  if (staging_.empty()) return;
  sync_names_beside(final_);
  std::error_code ignored;
  if (!replaced_.empty()) fs::remove_all(replaced_, ignored);
  forget_litter(staging_);
  staging_.clear();
  created_parents_.clear();
  replaced_.clear();
}

Status commit_together(const std::vector<Staged*>& outputs) {
  for (Staged* output : outputs) {
    throw_if_cancelled();
    CANYON_TRY_STATUS(output->seal());
  }
  throw_if_cancelled();
  {
    const auto held = hold_litter();
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      if (const auto placed = outputs[i]->place(); !placed.ok()) {
        while (i-- > 0) outputs[i]->take_back();
        return placed.error();
      }
    }
    if (!outputs.empty()) note_committed();
  }
  for (Staged* output : outputs) output->settle();
  return Ok{};
}

Status OutputSet::check_new(const std::string& path) {
  std::error_code code;
  const std::string place = fs::weakly_canonical(fs::absolute(path, code), code).string();
  if (std::find(paths_.begin(), paths_.end(), place) != paths_.end())
    return Error{path, 0, "", "named for two outputs", "a name for each"};
  paths_.push_back(place);
  return Ok{};
}

Result<std::string> OutputSet::place_of(const std::string& path) const {
  std::error_code code;
  const fs::path place = fs::weakly_canonical(fs::absolute(path, code), code);
  for (const auto& directory : directories_) {
    const fs::path top = fs::weakly_canonical(fs::absolute(directory->final_path(), code), code);
    const fs::path inner = place.lexically_relative(top);
    if (inner.empty() || *inner.begin() == ".." || inner == ".") continue;
    const fs::path inside = fs::path(directory->staging_path()) / inner;
    fs::create_directories(inside.parent_path(), code);
    if (fs::exists(inside, code))
      return Error{path, 0, "", "is one of the files of " + directory->final_path(), "another name"};
    return inside.string();
  }
  return path;
}

Result<StagedDirectory*> OutputSet::directory(const std::string& path) {
  if (path.empty()) return static_cast<StagedDirectory*>(nullptr);
  CANYON_TRY(auto made, StagedDirectory::create(path, force_));
  CANYON_TRY_STATUS(check_new(path));
  directories_.push_back(std::make_unique<StagedDirectory>(std::move(made)));
  return directories_.back().get();
}

Result<StagedFile*> OutputSet::file(const std::string& path) {
  if (path.empty()) return static_cast<StagedFile*>(nullptr);
  CANYON_TRY(const std::string place, place_of(path));
  CANYON_TRY(auto made, StagedFile::create(place, force_));
  if (!made.staging_path().empty()) CANYON_TRY_STATUS(check_new(path));
  files_.push_back(std::make_unique<StagedFile>(std::move(made)));
  return files_.back().get();
}

/// Files first: those inside a directory have their names before it is closed.
Status OutputSet::commit() {
  std::vector<Staged*> all;
  for (const auto& file : files_) all.push_back(file.get());
  for (const auto& directory : directories_) all.push_back(directory.get());
  return commit_together(all);
}

}  // namespace canyon
