#include <filesystem>

#include "canyon/core/config/config.h"
#include "canyon/core/config/named_file.h"

namespace canyon {
namespace {

/// Collects the fields that name files, with dotted keys.
class FileCollector final : public FieldVisitor {
 public:
  FileCollector(std::string prefix, std::vector<NamedFile>& out) : prefix_(std::move(prefix)), out_(out) {}

  void number(const char*, double&, Range, const char*) override {}
  void integer(const char*, std::int64_t&, Range, const char*) override {}
  void flag(const char*, bool&, const char*) override {}
  void text(const char*, std::string&, const char*) override {}
  void file(const char* key, std::string& value, std::string_view suffix, const char*) override {
    if (!value.empty() && value.ends_with(suffix)) out_.push_back({path(key), value});
  }
  void files(const char* key, std::vector<std::string>& value, const char*) override {
    for (const std::string& file : value) out_.push_back({path(key), file});
  }
  void choice(const char*, std::string&, const std::vector<std::string>&, const char*) override {}
  void choices(const char*, std::vector<std::string>&, const std::vector<std::string>&, const char*) override {}
  void numbers(const char*, std::vector<double>&, std::size_t, Range, const char*) override {}
  void texts(const char*, std::vector<std::string>&, const char*) override {}

 protected:
  void group_impl(const char* key, const char*, const std::function<void(FieldVisitor&)>& body) override {
    FileCollector inner(path(key), out_);
    body(inner);
  }
  void list_impl(const char* key, const char*, std::size_t size, const std::function<void(std::size_t)>&,
                 const std::function<void(std::size_t, FieldVisitor&)>& item) override {
    for (std::size_t i = 0; i < size; ++i) {
      FileCollector inner(path(key) + "[" + std::to_string(i + 1) + "]", out_);
      item(i, inner);
    }
  }

 private:
  std::string path(const std::string& key) const { return prefix_.empty() ? key : prefix_ + "." + key; }

  std::string prefix_;
  std::vector<NamedFile>& out_;
};

}  // namespace

std::vector<NamedFile> named_files(const VisitFunction& visit_fields) {
  std::vector<NamedFile> files;
  FileCollector collector("", files);
  visit_fields(collector);
  return files;
}

std::string path_as_named(const ConfigNode& node, const std::string& path) {
  const std::filesystem::path given(path);
  if (path.empty() || given.is_absolute() || node.line_ <= 0) return path;
  return (std::filesystem::path(node.file_).parent_path() / given).lexically_normal().string();
}

Error error_as_named(const ConfigNode& node, const std::string& key, const std::string& path, const Error& error) {
  if (error.file.empty()) return node.error(error.key, error.what, error.expected);
  const bool unreadable = error.line == 0 && error.key.empty();
  return unreadable ? node.error(key, "\"" + path + "\" " + error.what, error.expected) : error;
}

}  // namespace canyon
