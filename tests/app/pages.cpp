#include "tests/app/pages.hpp"

#include <algorithm>
#include <regex>
#include <set>
#include <utility>

#include "tests/scenarios/process.hpp"

namespace tandem::pages {
namespace {

using scenarios::text_of;

const fs::path kTop = test::kSourceDir;
constexpr int kSeconds = 2;  // after which a command gets Ctrl-C

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// Reads a page line by line.
class Reader {
 public:
  std::vector<Command> read(const std::string& markdown) {
    std::istringstream in(markdown);
    for (std::string line; std::getline(in, line);) {
      ++line_;
      if (line.starts_with("```"))
        fence(line.substr(3));
      else if (fenced_)
        body_ += line + "\n";
      else if (line.starts_with("<!-- "))
        mark(line);
      else
        prose(line);
    }
    end_paragraph();
    return std::move(commands_);
  }

 private:
  void fence(const std::string& language) {
    end_paragraph();
    fenced_ = !fenced_;
    if (fenced_) {
      language_ = language;
      begin_ = line_;
      body_.clear();
      return;
    }
    const std::size_t name = language_.find(' ');
    if (name != std::string::npos)
      commands_.push_back({Command::Kind::File, language_.substr(name + 1) + "\n" + body_, begin_, 0});
    else if (language_ == "sh")
      add(Command::Kind::Typed, body_);
    else
      printed();
    end_marks();
  }

  void end_marks() {
    not_run_ = keeps_ = false;
    seconds_ = kSeconds;
  }

  /// A block that is not `sh`: what a terminal showed, or anything else.
  void printed() {
    static const std::regex kPrompt("^\\$ (.*)$", std::regex::multiline);
    static const std::regex kCommand("^(\\./|)tandem [a-z]+ ", std::regex::multiline);
    for (std::sregex_iterator m(body_.begin(), body_.end(), kPrompt), end; m != end; ++m)
      add(Command::Kind::Typed, m->str(1) + "\n");
    if (std::regex_search(body_, kCommand)) add(Command::Kind::Astray, body_);
  }

  void mark(const std::string& line) {
    static const std::regex kMark("<!-- (not run|nothing here is run|keeps running|beside|takes|as)(: (.+))? -->");
    end_paragraph();
    begin_ = line_;
    std::smatch m;
    if (!std::regex_match(line, m, kMark)) return;  // a comment for people
    if (m[1] == "not run") {
      not_run_ = true;
      commands_.push_back({Command::Kind::NotRun, m[3], line_, 0});
    } else if (m[1] == "nothing here is run") {
      nothing_ = true;
      commands_.push_back({Command::Kind::NotRun, m[3], line_, 0});
    } else if (m[1] == "keeps running") {
      keeps_ = true;
    } else if (m[1] == "takes") {
      seconds_ = std::stoi(m[3]);
    } else if (m[1] == "beside") {
      commands_.push_back({Command::Kind::Left, said_as(m[3]), line_, 0});
    } else {
      const std::string both = m[3];
      const std::size_t is = both.find(" is ");
      as_.emplace_back(both.substr(0, is), both.substr(is + 4));
    }
  }

  void prose(const std::string& line) {
    if (line.empty()) return end_paragraph();
    if (paragraph_.empty()) begin_ = line_;
    paragraph_ += line + " ";
  }

  void end_paragraph() {
    static const std::regex kInline("`(\\./tandem [^`]+ [^`]+)`");
    static const std::regex kToFill("…|(^|[^A-Za-z0-9$_])[A-Z]{2,}($|[^A-Za-z0-9_])");
    for (std::sregex_iterator m(paragraph_.begin(), paragraph_.end(), kInline), end; m != end; ++m) {
      const std::string command = m->str(1);
      if (!std::regex_search(command, kToFill) && known_.insert(command).second) add(Command::Kind::Typed, command);
    }
    if (!paragraph_.empty()) end_marks();
    paragraph_.clear();
  }

  void add(Command::Kind kind, const std::string& text) {
    if (not_run_ || nothing_) return;
    if (keeps_ && kind == Command::Kind::Typed) kind = Command::Kind::Left;
    commands_.push_back({kind, said_as(text), begin_, seconds_});
  }

  std::string said_as(std::string text) const {
    for (const auto& [from, to] : as_) replace_all(text, from, to);
    return text;
  }

  std::vector<Command> commands_;
  std::vector<std::pair<std::string, std::string>> as_;
  std::set<std::string> known_;
  std::string body_, paragraph_, language_;
  bool fenced_ = false, not_run_ = false, keeps_ = false, nothing_ = false;
  int line_ = 0, begin_ = 0, seconds_ = kSeconds;
};

/// A clone as it is laid: what commands write lies in copies, the rest is linked. What is built is the build under
/// test.
void lay_clone(const fs::path& clone) {
  static const std::set<std::string> kOther = {".git", "build", "tandem", "docs", "CMakeLists.txt"};
  for (const auto& entry : fs::directory_iterator(kTop)) {
    const std::string name = entry.path().filename().string();
    if (name == "configs" || name == "studies")
      fs::copy(entry.path(), clone / name, fs::copy_options::recursive);
    else if (!kOther.contains(name))
      fs::create_symlink(entry.path(), clone / name);
  }
  fs::create_directories(clone / "docs/figures");
  fs::create_directories(clone / "build/release/tests");
  for (const auto& entry : fs::directory_iterator(test::kBuildDir)) {
    const std::string name = entry.path().filename().string();
    if (name != "tests" && name != "pages") fs::create_symlink(entry.path(), clone / "build/release" / name);
  }
  fs::create_symlink(kTop / "tests/app/page_tandem.sh", clone / "tandem");
}

/// Test programs that the page names: they only say whether there are such tests.
void lay_test_programs(const std::string& page, const fs::path& clone) {
  static const std::regex kProgram("build/release/tests/(test_\\w+)");
  for (std::sregex_iterator m(page.begin(), page.end(), kProgram), end; m != end; ++m) {
    const fs::path program = clone / m->str();
    if (!fs::exists(fs::symlink_status(program))) fs::create_symlink(kTop / "tests/app/page_tandem.sh", program);
  }
}

/// A page as a script for bash. `slower`: how many times as long commands may take.
std::string script_of(const fs::path& file, int slower) {
  std::ostringstream script;
  script << ". '" << (kTop / "tests/app/page_shell.sh").string() << "'\n";
  int left = 0;
  for (const Command& command : commands_of(text_of(file))) {
    if (command.kind == Command::Kind::NotRun || command.kind == Command::Kind::Astray) continue;
    script << "at '" << fs::relative(file, kTop).string() << ":" << command.line << "'\n";
    if (command.kind == Command::Kind::File) {
      const std::size_t end = command.text.find('\n');
      script << "cat >'" << command.text.substr(0, end) << "' <<'END OF FILE'" << command.text.substr(end)
             << "END OF FILE\n";
    } else if (command.kind == Command::Kind::Left) {
      const std::string name = "left" + std::to_string(++left);
      script << name << "() {\n" << command.text << "\n}\nleave " << name << "\n";
    } else {
      script << "PAGE_SECONDS=" << command.seconds * slower << "\n" << command.text << "\n";
    }
  }
  script << "finish\n";
  return script.str();
}

}  // namespace

std::vector<fs::path> documents() {
  std::vector<fs::path> all = {kTop / "CONTRIBUTING.md", kTop / "README.md"};
  for (const char* folder :
       {"docs", "app", "bench", "bridges", "core", "mixed_reality", "studies", "tests", "validate"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kTop / folder)) {
      if (entry.path().extension() == ".md") all.push_back(entry.path());
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::string name_of(const fs::path& page) {
  std::string name = fs::relative(page, kTop).replace_extension().string();
  replace_all(name, "/", "-");
  return name;
}

std::map<std::string, std::string> named_blocks(const std::string& markdown) {
  static const std::regex kBlock("```\\w+ (\\S+)\n([^`]*)```");
  std::map<std::string, std::string> blocks;
  for (std::sregex_iterator m(markdown.begin(), markdown.end(), kBlock), end; m != end; ++m)
    blocks[m->str(1)] = m->str(2);
  return blocks;
}

std::vector<Command> commands_of(const std::string& markdown) {
  return Reader().read(markdown);
}

// One folder a page, at the same place each time: a compiler cache knows what was compiled there.
Page::Page(const fs::path& file)
    : file_(file), room_(fs::path(test::kBuildDir) / "pages" / name_of(file)), folder_(room_ / "tandem") {}

void Page::run() {
  if (type_all(1) != 0) (void)type_all(4);
}

int Page::type_all(int slower) const {
  fs::remove_all(room_);
  fs::create_directories(folder_);
  lay_clone(folder_);
  lay_test_programs(text_of(file_), folder_);
  std::ofstream(room_ / "page.sh") << script_of(file_, slower);
  scenarios::stand_apart();
  const std::string mark = "TANDEM_PAGE=" + room_.string() + ".";
  const std::string run = mark + " PAGE_ROOM='" + room_.string() + "' PAGE_BUILD='" + test::kBuildDir + "' bash '" +
                          (kTop / "tests/app/page_room.sh").string() + "'";
  const int code = std::system(run.c_str());
  for (const int signal : {SIGTERM, SIGKILL}) {
    const auto none = [&] {
      const auto still = scenarios::processes_marked(mark);
      for (const pid_t process : still) kill(process, signal);
      return still.empty();
    };
    if (scenarios::eventually(none, 5.0)) break;
  }
  if (code != 0 && !fs::exists(room_ / "failed"))
    std::ofstream(room_ / "failed") << "the page's script ended with " << code << "\n";
  return code;
}

std::string Page::failed() const {
  return text_of(room_ / "failed");
}

std::string Page::log() const {
  return text_of(room_ / "log");
}

}  // namespace tandem::pages
