#include "canyon/tests/report/markup.h"

#include <cctype>

namespace canyon::testing {

std::string without(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t start; (start = text.find(from)) != std::string::npos;) {
    const std::size_t end = text.find(to, start + from.size());
    if (end == std::string::npos) break;
    text.erase(start, end + to.size() - start);
  }
  return text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::vector<std::string> attributes(const std::string& html, const std::string& name) {
  std::vector<std::string> out;
  const std::string mark = " " + name + "=\"";
  for (std::size_t at = html.find(mark); at != std::string::npos; at = html.find(mark, at + 1)) {
    const std::size_t start = at + mark.size();
    out.push_back(html.substr(start, html.find('"', start) - start));
  }
  return out;
}

bool has_word(const std::string& text, const std::string& word) {
  const auto letter = [&](std::size_t i) {
    return i < text.size() && std::isalnum(static_cast<unsigned char>(text[i])) != 0;
  };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    if (!(at > 0 && letter(at - 1)) && !letter(at + word.size())) return true;
  }
  return false;
}

std::vector<std::string> after(const std::string& text, const std::string& mark, std::size_t length) {
  std::vector<std::string> out;
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
    out.push_back(text.substr(at + mark.size(), length));
  }
  return out;
}

}  // namespace canyon::testing
