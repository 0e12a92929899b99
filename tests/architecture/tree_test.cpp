// The tree itself: no source is left out of the build, no document names a file that is not there.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace fude {
namespace {

namespace fs = std::filesystem;

const fs::path root = FUDE_SOURCE_DIR;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Of the folder and those above it: a folder may list what lies in another below it.
std::string build_lists(fs::path folder) {
  std::string lists;
  for (; folder != root.parent_path(); folder = folder.parent_path())
    if (fs::exists(folder / "CMakeLists.txt")) lists += text_of(folder / "CMakeLists.txt");
  return lists;
}

TEST(Tree, EverySourceIsBuilt) {
  int sources = 0;
  for (const char* top : {"signal", "drivers", "capture", "calibration", "sim", "rig", "app", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      if (entry.path().extension() != ".cpp") continue;
      ++sources;
      EXPECT_NE(build_lists(entry.path().parent_path()).find(entry.path().stem().string()), std::string::npos)
          << fs::relative(entry.path(), root) << " is in no CMakeLists.txt: nobody compiles it";
    }
  EXPECT_GT(sources, 100);
}

// `path/to/file.ext` in the prose of the documents; what stands for many, as *.k, is not looked for.
TEST(Tree, DocumentsNameFilesThatAreThere) {
  static const std::regex named(
      R"(`((?:app|calibration|capture|drivers|rig|share|signal|sim|tests|tools|docs)/[\w./-]+\.\w+)`)");
  std::vector<fs::path> documents{root / "README.md"};
  for (const char* folder : {"docs", "firmware-notes"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ".md") documents.push_back(entry.path());
  int names = 0;
  for (const fs::path& document : documents) {
    const std::string text = text_of(document);
    for (std::sregex_iterator i(text.begin(), text.end(), named), end; i != end; ++i, ++names)
      EXPECT_TRUE(fs::exists(root / (*i)[1].str())) << fs::relative(document, root) << " names " << (*i)[1];
  }
  EXPECT_GT(names, 20);
}

}  // namespace
}  // namespace fude
