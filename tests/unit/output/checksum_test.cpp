// Damage of any file of a run is seen before it is read; a folder has one writer.
#include <boost/test/unit_test.hpp>
#include <random>

#include "support/run_program.hpp"
#include "unit/output/synthetic_run.hpp"
#include "windlass/output/checksum.hpp"
#include "windlass/output/error.hpp"
#include "windlass/output/folder_lock.hpp"

using namespace windlass::output;
using windlass::test::TemporaryFolder;
namespace fs = std::filesystem;

BOOST_AUTO_TEST_SUITE(damage)

BOOST_AUTO_TEST_CASE(every_flipped_bit_changes_the_checksum) {
  std::string text = "branch,point\n1,2\n";
  const std::string right = checksum(text);
  for (std::size_t bit = 0; bit < 8 * text.size(); ++bit) {
    text[bit / 8] ^= static_cast<char>(1 << bit % 8);
    BOOST_TEST(checksum(text) != right);
    text[bit / 8] ^= static_cast<char>(1 << bit % 8);
  }
  BOOST_TEST(checksum(text) == right);
  BOOST_TEST(checksum(text + '\0') != right);
  BOOST_TEST(unsealed(sealed(text), "file") == text);
  BOOST_CHECK_THROW(unsealed(text, "file"), OutputError);
}

BOOST_AUTO_TEST_CASE(five_hundred_damaged_runs) {
  const TemporaryFolder folder;
  const fs::path run = folder / "run";
  windlass::test::write_synthetic_run(run);
  BOOST_TEST(read_run(run).points.size() > 50u);
  const char* files[] = {"points.h5",    "points.h5",           "run.json",
                         "branches.csv", "special_points.json", "scene.toml"};
  std::mt19937 random(4);
  for (int k = 0; k < 500; ++k) {
    const fs::path path = run / files[k % std::size(files)];
    const std::string right = windlass::test::slurp(path);
    std::string wrong = right;
    const int flips = 1 + static_cast<int>(random() % 4);
    for (int flip = 0; flip < flips; ++flip)
      wrong[random() % wrong.size()] ^= static_cast<char>(1 + random() % 255);
    if (random() % 8 == 0) wrong.resize(random() % wrong.size());
    if (wrong == right) continue;
    std::ofstream(path, std::ios::binary) << wrong;
    std::string message;
    try {
      read_run(run);
      // Between the tokens of JSON a blank may have become another one; nothing else passes.
      const bool equal =
          path.filename() == "run.json" && nlohmann::json::parse(wrong) == nlohmann::json::parse(right);
      message = equal ? path.string() : "accepted";
    } catch (const OutputError& error) {
      message = error.what();
    }
    BOOST_TEST(message.find(path.string()) != std::string::npos,
               "case " << k << ", " << path << ": " << message);
    std::ofstream(path, std::ios::binary) << right;
  }
  read_run(run);
}

BOOST_AUTO_TEST_CASE(a_second_writer_is_refused) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "a");
  {
    const FolderLock first(folder / "a");
    BOOST_CHECK_THROW(FolderLock(folder / "a"), OutputError);
    fs::rename(folder / "a", folder / "b");
    BOOST_CHECK_THROW(FolderLock(folder / "b"), OutputError);
  }
  const FolderLock again(folder / "b");
}

BOOST_AUTO_TEST_SUITE_END()
