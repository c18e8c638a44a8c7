// `tandem validate`: makes the parts of the report one after the other, and writes page, PDF and JSON into a folder.
#include "app/command/command.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <thread>

#include "app/build_info.hpp"
#include "app/module/module_table.hpp"
#include "core/view/gnuplot.hpp"
#include "core/view/render.hpp"
#include "hal/output_file.hpp"
#include "hal/sha256.hpp"
#include "validate/page.hpp"
#include "validate/parts.hpp"

namespace tandem::validate {
namespace {

struct ValidateOptions {
  std::string out = "validation";  ///< folder of the report
  std::vector<std::string> only;   ///< parts by name; empty: all
  bool brief = false;              ///< the short form

  void describe(hal::CommandLine& line) {
    line.footer("Exit code: 0 all contracts are met, 4 one is not, 3 the report cannot be made.");
    line.option("-o,--out", out, "Folder for validation.html, .pdf, .json and figures").show_default().folder();
    line.flag("--short", brief, "The short form: less than a minute");
    line.option("--only", only, "Only these parts: engines, sensors, noise, …").separated();
  }
};

using Clock = std::chrono::steady_clock;

struct PartMaker {
  const char* name;  ///< as --only has it
  Part (*make)(Depth);
};
constexpr PartMaker kParts[] = {{"engines", engine_part}, {"sensors", sensor_part},  {"noise", noise_part},
                                {"mixed", mixed_part},    {"barrier", barrier_part}, {"case_study", case_study_part}};

int refuse(int code, const std::string& why) {
  std::fprintf(stderr, "tandem validate: %s\n", why.c_str());
  return code;
}

/// What the rows say, without the time that it took: equal where the results are.
std::string fingerprint_of(const Report& report) {
  std::string text;
  for (const Part& part : report.parts)
    for (const Table& table : part.tables)
      for (const Row& row : table.rows) {
        for (const std::string& cell : row.cells) text += cell + '\t';
        text += '\n';
      }
  return hal::sha256(text);
}

std::vector<std::pair<std::string, std::string>> about(const ValidateOptions& options, double seconds) {
  const app::BuildInfo& info = app::build_info();
  char date[32] = {};
  const std::time_t now = std::time(nullptr);
  std::tm utc = {};
  std::strftime(date, sizeof date, "%F %T UTC", gmtime_r(&now, &utc));
  return {{"release", info.version + (info.commit.empty() ? "" : ", commit " + info.commit)},
          {"compiler", info.compiler + ", " + info.build},
          {"machine",
           fmt::format("{}, {} processors; {}", info.processor, std::thread::hardware_concurrency(), info.system)},
          {"made", fmt::format("{}, {} form, in {:.0f} s", date, options.brief ? "short" : "full", seconds)}};
}

hal::Result<std::string> drawn(const Figure& figure, const std::filesystem::path& file) {
  auto out = hal::OutputFile::open(file.string(), "figure");
  if (!out.ok()) return out.error();
  auto opened = std::move(out).value();
  const std::string script =
      core::gnuplot_terminal(core::FigureFormat::Svg, {}) +
      "set encoding utf8\nset grid\nset key outside top center vertical maxrows 3 samplen 2\nset rmargin 4\n" +
      figure.script;
  if (const hal::Status status = core::draw_figure(script, opened); !status.ok()) return status.error();
  std::ifstream in(file);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

hal::Status write(const Report& report, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder / "figures", error);
  if (error) return hal::Error{fmt::format("the folder {} cannot be made: {}", folder.string(), error.message())};
  std::vector<std::vector<std::string>> figures;
  for (const Part& part : report.parts) {
    figures.emplace_back();
    for (const Figure& figure : part.figures) {
      auto svg = drawn(figure, folder / "figures" / (figure.name + ".svg"));
      if (!svg.ok()) return svg.error();
      figures.back().push_back(std::move(svg).value());
    }
  }
  const auto pdf = core::render_pages(sheets_of(report, figures));
  if (!pdf.ok()) return pdf.error();
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"validation.html", page_of(report)},
                                   {"validation.json", hal::to_text(json_of(report), 1) + "\n"},
                                   {"validation.pdf", pdf.value()}}) {
    if (const hal::Status done = hal::write_whole_file((folder / name).string(), "report", text); !done.ok())
      return done;
  }
  return {};
}

/// Names each row whose contract does not hold.
void tell(const Part& part) {
  for (const Table& table : part.tables)
    for (const Row& row : table.rows) {
      if (row.verdict != Verdict::NotMet && row.verdict != Verdict::NotMade) continue;
      std::printf("  %s: %s: %s (%s)\n", row.verdict == Verdict::NotMet ? "not met" : "not made", table.title.c_str(),
                  fmt::format("{}", fmt::join(row.cells, " | ")).c_str(), row.contract.c_str());
    }
  std::fflush(stdout);
}

int run(const ValidateOptions& options) {
  if (const hal::Status can = core::can_draw_figures(); !can.ok())
    return refuse(app::kFailedRunning, can.error().message);
  const Clock::time_point began = Clock::now();
  const auto since = [](Clock::time_point then) { return std::chrono::duration<double>(Clock::now() - then).count(); };
  Report report;
  for (const PartMaker& maker : kParts) {
    if (!options.only.empty() && std::find(options.only.begin(), options.only.end(), maker.name) == options.only.end())
      continue;
    const Clock::time_point then = Clock::now();
    report.parts.push_back(maker.make(options.brief ? Depth::Short : Depth::Full));
    report.parts.back().seconds = since(then);
    std::printf("%s: %.1f s\n", report.parts.back().title.c_str(), report.parts.back().seconds);
    tell(report.parts.back());
  }
  if (report.parts.empty()) {
    std::string names;
    for (const PartMaker& maker : kParts) names += (names.empty() ? "" : ", ") + std::string(maker.name);
    return refuse(app::kWrongUsage, "--only names no part; there are: " + names);
  }
  report.about = about(options, since(began));
  report.about.emplace_back("fingerprint of the rows", fingerprint_of(report));
  if (const hal::Status written = write(report, options.out); !written.ok())
    return refuse(app::kFailedRunning, written.error().message);
  std::printf("%s\n%s\n", summary_of(report).c_str(), (std::filesystem::path(options.out) / "validation.html").c_str());
  const Count all = count(report);
  return all.not_met + all.not_made == 0 ? app::kDone : app::kDifferent;
}

}  // namespace
}  // namespace tandem::validate

constinit const tandem::hal::CommandType tandem::app::validate_command =
    tandem::app::module_command<tandem::validate::ValidateOptions, tandem::validate::run>("validate");
