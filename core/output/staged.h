#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/result.h"

namespace canyon {

/// `path`, or `path`-2, -3, ... where nothing of that name exists; of a file the number stands before its extension.
std::string free_name(const std::string& path);
std::string free_file_name(const std::string& path);

/// An output that appears under its final name only when it is complete and on the disk (fsync). Until commit() it is
/// written under a temporary name beside it; the destructor removes what was not committed. A temporary name is unlike
/// that of any other process on any host, and those of processes that were killed are taken away when the next output
/// is made in the same folder. What stood under the name before stays until it is replaced in one step.
class Staged {
 public:
  virtual ~Staged();
  Staged& operator=(Staged&&) = delete;

  const std::string& staging_path() const { return staging_; }
  /// Where it will be. After commit(), where it is: if without `force` another has taken the name meanwhile, what was
  /// computed is not lost but has the next free_name().
  const std::string& final_path() const { return final_; }
  /// Fails (exit 1) on a full disk; everything is then as it was before.
  Status commit();

 protected:
  Staged(std::string final_path, std::string staging, bool force, std::vector<std::string> created_parents);
  Staged(Staged&& other) noexcept;

 private:
  friend Status commit_together(const std::vector<Staged*>& outputs);
  /// Everything that may fail for want of space: the content reaches the disk.
  virtual Status seal() = 0;
  /// Whether what now stands under the final name may be replaced.
  virtual Status check_replaced() const = 0;
  virtual std::string next_free_name() const = 0;
  Status place();
  void take_back();
  void settle();

  std::string final_, staging_;  ///< no staging: the output is written straight to a device or pipe, or was committed
  bool force_ = false;
  std::vector<std::string> created_parents_;  ///< outermost first; taken away again if nothing is committed
  std::string replaced_;                      ///< what stood under the final name, between place() and settle()
};

/// Several outputs of one command get their names together: all, or, if one cannot, none.
Status commit_together(const std::vector<Staged*>& outputs);

class StagedDirectory : public Staged {
 public:
  /// Fails (exit 2) if `path` exists and `force` is false, or if it cannot be written. With `force` an existing one is
  /// replaced if it is empty or was put in place by commit(), which leaves the file `.canyon` in it; no other directory
  /// is ever touched. Parents that are missing are made.
  static Result<StagedDirectory> create(const std::string& path, bool force);
  StagedDirectory(StagedDirectory&& other) noexcept = default;

 private:
  using Staged::Staged;
  Status seal() override;
  Status check_replaced() const override;
  std::string next_free_name() const override;
};

class StagedFile : public Staged {
 public:
  /// Fails (exit 2) if a file exists at `path` and `force` is false, or if it cannot be written. With `force` it is
  /// replaced, a link's target and not the link. A device, a pipe or the standard output itself is written straight to.
  static Result<StagedFile> create(const std::string& path, bool force);
  StagedFile(StagedFile&& other) noexcept;
  ~StagedFile() override;

  /// Appends.
  Status write(std::string_view bytes);

 private:
  StagedFile(std::string final_path, std::string staging, bool force, int descriptor);
  static Result<StagedFile> straight_to(const std::string& path, int descriptor);
  Status flush();
  Status seal() override;
  Status check_replaced() const override;
  std::string next_free_name() const override;

  int descriptor_ = -1;
  std::string buffer_;
};

/// The outputs of one command, of which some may not be asked for, and files may lie in its own directory.
class OutputSet {
 public:
  explicit OutputSet(bool force) : force_(force) {}

  /// nullptr for an empty path: not wanted. Fails as create() does, and (exit 2) if two outputs have the same path.
  /// Directories before the files that lie in them.
  Result<StagedDirectory*> directory(const std::string& path);
  Result<StagedFile*> file(const std::string& path);
  Status commit();

 private:
  /// Where a file really goes: inside a directory of this set that is still being filled, or where it says.
  Result<std::string> place_of(const std::string& path) const;
  Status check_new(const std::string& path);

  bool force_;
  std::vector<std::unique_ptr<StagedFile>> files_;
  std::vector<std::unique_ptr<StagedDirectory>> directories_;
  std::vector<std::string> paths_;
};

}  // namespace canyon
