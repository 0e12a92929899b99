// Every command line that a document shows is one that the program has, with those very options.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace fude {
namespace {

namespace fs = std::filesystem;

struct CommandLine {
  std::string shown;  // with the document that shows it
  std::vector<std::string> words;
};

// Lines that are indented by four spaces and begin with fude or ./run, without their remark.
std::vector<CommandLine> command_lines() {
  const fs::path root = FUDE_SOURCE_DIR;
  std::vector<fs::path> documents{root / "README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") documents.push_back(entry.path());
  static const std::regex command(R"(^    (?:fude|\./run) +([a-z][^#]*).*)");
  std::vector<CommandLine> found;
  for (const fs::path& document : documents) {
    std::ifstream in(document);
    for (std::string line; std::getline(in, line);) {
      std::smatch parts;
      if (!std::regex_match(line, parts, command)) continue;
      CommandLine shown{document.filename().string() + ": " + line, {}};
      std::istringstream words(parts[1].str());
      for (std::string word; words >> word;) shown.words.push_back(word);
      found.push_back(shown);
    }
  }
  return found;
}

struct Answer {
  std::string text;
  int status = -1;
};
Answer help_of(const std::string& command) {
  static std::map<std::string, Answer> known;
  if (const auto before = known.find(command); before != known.end()) return before->second;
  Answer answer;
  FILE* pipe = popen((std::string(FUDE_PROGRAM) + " " + command + " --help 2>&1").c_str(), "r");
  std::array<char, 4096> piece{};
  for (std::size_t n = 0; (n = fread(piece.data(), 1, piece.size(), pipe)) > 0;)
    answer.text.append(piece.data(), n);
  answer.status = pclose(pipe);
  return known[command] = answer;
}

bool is_name(const std::string& word) {
  return !word.starts_with('-') &&
         std::all_of(word.begin(), word.end(), [](char c) { return (c >= 'a' && c <= 'z') || c == '-'; });
}

bool has_subcommands(const Answer& help) { return help.text.find("Subcommands:") != std::string::npos; }

bool names_option(const std::string& help, const std::string& option) {
  return std::regex_search(help, std::regex(option + R"((?![\w-]))"));
}

TEST(DocumentedCommands, AreThoseOfTheProgram) {
  const std::vector<CommandLine> lines = command_lines();
  EXPECT_GT(lines.size(), 30u);
  for (const CommandLine& line : lines) {
    std::string command = line.words[0];
    if (command == "build") continue;  // ./run's own
    if (line.words.size() > 1 && is_name(line.words[1]) && has_subcommands(help_of(command)))
      command += " " + line.words[1];
    const Answer help = help_of(command);
    EXPECT_EQ(help.status, 0) << line.shown << "\n" << help.text;
    // brushes lists what its subcommand shows one of.
    EXPECT_TRUE(command == "brushes" || !has_subcommands(help))
        << line.shown << "\nnames no command of " << command;
    for (const std::string& word : line.words)
      if (word.starts_with("--")) {
        const std::string option = word.substr(0, word.find('='));
        EXPECT_TRUE(names_option(help.text, option)) << line.shown << "\nhas no " << option;
      }
  }
}

}  // namespace
}  // namespace fude
