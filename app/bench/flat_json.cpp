#include "app/bench/flat_json.hpp"

#include <charconv>

namespace tandem::app {
namespace {

void append_utf8(std::string& out, unsigned code) {
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xC0 | (code >> 6));
    out += static_cast<char>(0x80 | (code & 0x3F));
  } else {
    out += static_cast<char>(0xE0 | (code >> 12));
    out += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
    out += static_cast<char>(0x80 | (code & 0x3F));
  }
}

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  hal::Result<FlatObject> object() {
    FlatObject all;
    if (!take('{')) return fail("no '{'");
    if (!take('}')) {
      do {
        if (!member(all)) return fail(why_);
      } while (take(','));
      if (!take('}')) return fail("neither ',' nor '}'");
    }
    skip_space();
    if (at_ != text_.size()) return fail("something after the object");
    return all;
  }

 private:
  hal::Error fail(const std::string& why) const {
    return {"it is no flat JSON object: " + why + " at character " + std::to_string(at_ + 1)};
  }

  void skip_space() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\r')) ++at_;
  }
  bool take(char c) {
    skip_space();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  bool take_word(std::string_view word) {
    if (!text_.substr(at_).starts_with(word)) return false;
    at_ += word.size();
    return true;
  }
  bool refuse(const char* why) {
    why_ = why;
    return false;
  }

  bool member(FlatObject& all) {
    std::string name;
    if (!take('"')) return refuse("no name in quotes");
    if (!string(name)) return false;
    if (!take(':')) return refuse("no ':'");
    FlatValue v;
    if (!value(v)) return false;
    return all.emplace(std::move(name), std::move(v)).second || refuse("a name that was there before");
  }

  bool value(FlatValue& v) {
    skip_space();
    if (take('"')) {
      std::string text;
      if (!string(text)) return false;
      v = std::move(text);
      return true;
    }
    if (take_word("null")) return true;
    if (take_word("true")) {
      v = true;
      return true;
    }
    if (take_word("false")) {
      v = false;
      return true;
    }
    return number(v);
  }

  bool number(FlatValue& v) {
    const std::string_view rest = text_.substr(at_);
    const std::size_t first = rest.starts_with('-') ? 1 : 0;
    if (first >= rest.size() || rest[first] < '0' || rest[first] > '9') return refuse("no text, number or word");
    double n = 0.0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), n);
    if (error != std::errc{}) return refuse("a number that is too large or too small");
    at_ += static_cast<std::size_t>(end - rest.data());
    v = n;
    return true;
  }

  /// What follows an opening quote, with the closing one.
  bool string(std::string& out) {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (static_cast<unsigned char>(c) < 0x20) return refuse("a control character in a text");
      ++at_;
      if (c == '"') return true;
      if (c != '\\')
        out += c;
      else if (!escape(out))
        return refuse("an unknown escape");
    }
    return refuse("a text without its closing quote");
  }

  bool escape(std::string& out) {
    static constexpr std::string_view kLetters = "\"\\/bfnrt";
    static constexpr std::string_view kMeanings = "\"\\/\b\f\n\r\t";
    if (at_ == text_.size()) return false;
    const char c = text_[at_];
    if (const std::size_t i = kLetters.find(c); i != std::string_view::npos) {
      out += kMeanings[i];
      ++at_;
      return true;
    }
    unsigned code = 0;
    if (c != 'u' || at_ + 5 > text_.size()) return false;
    const char* const begin = text_.data() + at_ + 1;
    const auto [end, error] = std::from_chars(begin, begin + 4, code, 16);
    if (error != std::errc{} || end != begin + 4 || (code >= 0xD800 && code < 0xE000)) return false;
    append_utf8(out, code);
    at_ += 5;
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::string why_;
};

}  // namespace

hal::Result<FlatObject> parse_flat_json(std::string_view text) {
  return Parser(text).object();
}

}  // namespace tandem::app
