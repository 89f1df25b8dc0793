#pragma once

#include <string>
#include <utility>
#include <variant>

#include "canyon/core/check.h"

namespace canyon {

/// A mistake in what the user gave us (a file, a key, an option), told in one line.
/// Physics is never an Error: too few satellites or a failed mission are statuses inside a result.
struct Error {
  std::string file{};      ///< file or option the mistake is in; may be empty
  int line = 0;            ///< 1-based; 0 = not tied to a line
  std::string key{};       ///< dotted configuration key or field name; may be empty
  std::string what{};      ///< what is wrong, with the offending value
  std::string expected{};  ///< what was expected; may be empty
  int exit_code = 2;       ///< 2 = bad input, 1 = the computation could not finish

  /// `file:line: key: what, expected ...`, parts that are empty left out; one line in any case (core/printable_text.h).
  std::string str() const;
};

struct Ok {};

/// Either a value or an Error. Accessing the missing one is a programmer's mistake and throws.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : data_(std::move(value)) {}      // NOLINT: implicit by intent, `return value;`
  Result(Error error) : data_(std::move(error)) {}  // NOLINT: implicit by intent, `return Error{...};`

  bool ok() const { return data_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& operator*() & { return checked(); }
  const T& operator*() const& { return const_cast<Result*>(this)->checked(); }
  T&& operator*() && { return std::move(checked()); }
  T* operator->() { return &checked(); }
  const T* operator->() const { return &const_cast<Result*>(this)->checked(); }

  const Error& error() const {
    CANYON_CHECK(!ok(), "error() of a Result that holds a value");
    return std::get<1>(data_);
  }

 private:
  T& checked() {
    if (!ok()) throw_failed_check("Result holds a value", __FILE__, __LINE__, std::get<1>(data_).str());
    return std::get<0>(data_);
  }

  std::variant<T, Error> data_;
};

using Status = Result<Ok>;

#define CANYON_CONCAT_INNER(a, b) a##b
#define CANYON_CONCAT(a, b) CANYON_CONCAT_INNER(a, b)
#define CANYON_TRY_INNER(tmp, declaration, expression) \
  auto tmp = (expression);                             \
  if (!tmp.ok()) return tmp.error();                   \
  declaration = *std::move(tmp)

/// CANYON_TRY(auto x, f()): declares x = the value of f(), or returns f()'s Error from the enclosing function.
#define CANYON_TRY(declaration, expression) \
  CANYON_TRY_INNER(CANYON_CONCAT(canyon_try_, __LINE__), declaration, expression)

/// CANYON_TRY_STATUS(f()): returns f()'s Error, if any, from the enclosing function.
#define CANYON_TRY_STATUS(expression)                                                         \
  do {                                                                                        \
    if (auto canyon_status = (expression); !canyon_status.ok()) return canyon_status.error(); \
  } while (false)

}  // namespace canyon
