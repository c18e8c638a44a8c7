// Arguments of programs, and of the command `argos3`.
#include <algorithm>
#include <argos3/core/config.h>
#include <argos3/core/simulator/argos_command_line_arg_parser.h>
#include <argos3/core/simulator/query_plugins.h>
#include <argos3/core/simulator/simulator.h>
#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/configuration/command_line_arg_parser.h>
#include <cstdlib>
#include <utility>

namespace argos {

CCommandLineArgParser::CCommandLineArgParser() {}
CCommandLineArgParser::~CCommandLineArgParser() {}

void CCommandLineArgParser::PrintUsage(CARGoSLog& log) {
  for (const SArgument& one : m_vecArguments)
    log << "  -" << one.Short << ", --" << one.Long << (one.IsFlag ? "" : " VALUE") << "  " << one.Description
        << std::endl;
}

const CCommandLineArgParser::SArgument& CCommandLineArgParser::Find(const std::string& name, bool is_short) const {
  for (const SArgument& one : m_vecArguments) {
    if (is_short ? name == std::string(1, one.Short) : name == one.Long) return one;
  }
  THROW_ARGOSEXCEPTION("unknown argument '" << (is_short ? "-" : "--") << name << "'")
}

void CCommandLineArgParser::Parse(SInt32 count, char** values) {
  for (SInt32 i = 1; i < count; ++i) {
    const std::string word = values[i];
    if (word.size() < 2 || word[0] != '-')
      THROW_ARGOSEXCEPTION("unexpected argument '" << word << "'; arguments begin with '-'")
    const bool is_short = word[1] != '-';
    const std::size_t equals = is_short ? std::string::npos : word.find('=');
    std::vector<std::string> names;
    if (is_short)
      for (const char c : word.substr(1)) names.emplace_back(1, c);
    else
      names.push_back(word.substr(2, equals == std::string::npos ? equals : equals - 2));
    for (const std::string& name : names) {
      const SArgument& argument = Find(name, is_short);
      if (argument.IsFlag) {
        argument.Set("");
      } else if (equals != std::string::npos) {
        argument.Set(word.substr(equals + 1));
      } else {
        if (names.size() > 1 || ++i >= count) THROW_ARGOSEXCEPTION("the argument '" << word << "' needs a value")
        argument.Set(values[i]);
      }
    }
  }
}

CARGoSCommandLineArgParser::CARGoSCommandLineArgParser() : m_eAction(ACTION_UNKNOWN) {
  AddFlag('h', "help", "prints this", m_bHelpWanted);
  AddFlag('v', "version", "prints the version", m_bVersionWanted);
  AddFlag('n', "no-color", "without colours, as always", m_bNonColoredLog);
  AddFlag('z', "no-visualization", "leaves out <visualization>", m_bForceNoViz);
  AddArgument<std::string>('c', "config-file", "runs this experiment", m_strExperimentConfigFile);
  AddArgument<std::string>('q', "query", "lists what there is, or describes one of it", m_strQuery);
  AddArgument<std::string>('l', "log-file", "LOG is written there, too", m_strLogFile);
  AddArgument<std::string>('e', "logerr-file", "LOGERR is written there, too", m_strLogErrFile);
}
CARGoSCommandLineArgParser::~CARGoSCommandLineArgParser() {}

void CARGoSCommandLineArgParser::Parse(SInt32 count, char** values) {
  CCommandLineArgParser::Parse(count, values);
  const std::vector<std::pair<bool, EAction>> asked = {{!m_strExperimentConfigFile.empty(), ACTION_RUN_EXPERIMENT},
                                                       {!m_strQuery.empty(), ACTION_QUERY},
                                                       {m_bHelpWanted, ACTION_SHOW_HELP},
                                                       {m_bVersionWanted, ACTION_SHOW_VERSION}};
  if (std::count_if(asked.begin(), asked.end(), [](const auto& one) { return one.first; }) != 1)
    THROW_ARGOSEXCEPTION("give one of --config-file FILE, --query WHAT, --help, --version")
  for (const auto& one : asked) {
    if (one.first) m_eAction = one.second;
  }
  if (!m_strLogFile.empty()) LOG.RedirectToFile(m_strLogFile);
  if (!m_strLogErrFile.empty()) LOGERR.RedirectToFile(m_strLogErrFile);
}

void QueryPlugins(const std::string& query) {
  std::string quoted = "'";
  for (const char c : query) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  const std::string prefix = CSimulator::GetInstance().GetInstallationDirectory();
  const std::string command = (prefix.empty() ? "argos3" : "'" + prefix + "/bin/argos3'") + " -q " + quoted + "'";
  if (std::system(command.c_str()) != 0) THROW_ARGOSEXCEPTION("'" << command << "' failed")
}

void CARGoSCommandLineArgParser::PrintUsage(CARGoSLog& log) {
  log << "Runs experiments of ARGoS 3 in Tandem." << std::endl;
  CCommandLineArgParser::PrintUsage(log);
}

void CARGoSCommandLineArgParser::PrintVersion() {
  LOG << "Tandem's ARGoS " << ARGOS_VERSION << "-" << ARGOS_RELEASE << std::endl;
}

}  // namespace argos
