#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "canyon/core/result.h"

namespace canyon::scene {

/// An element of an XML file; names without their namespace prefix. A view: valid as long as its XmlFile.
class XmlElement {
 public:
  XmlElement() = default;
  explicit XmlElement(const void* node) : node_(node) {}
  explicit operator bool() const { return node_ != nullptr; }

  std::string_view name() const;
  int line() const;
  /// An attribute's value, by name without prefix; nullopt if there is none.
  std::optional<std::string> attribute(const char* name) const;
  /// All text inside, children's included.
  std::string text() const;

  XmlElement first_child() const;
  XmlElement next() const;
  /// The first child of that name; an empty element if there is none.
  XmlElement child(std::string_view name) const;
  /// Calls visit for every element below this one, depth first, itself left out. Where visit returns false, what lies
  /// below is left out.
  void walk(const std::function<bool(const XmlElement&)>& visit) const;

 private:
  const void* node_ = nullptr;
};

/// A parsed file, plain or gzipped. Nothing outside of it is ever fetched. Files that declare entities or attributes,
/// that nest elements more than 256 deep or hold a single text of more than 10 MB are refused: their cost would not
/// follow from their size.
class XmlFile {
 public:
  static Result<XmlFile> load(const std::string& path);
  XmlElement root() const;

 private:
  std::shared_ptr<const void> document_;
};

}  // namespace canyon::scene
