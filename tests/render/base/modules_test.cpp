#include "render/base/modules.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>

namespace beamcam::render {
namespace {

namespace fs = std::filesystem;

class Modules : public ::testing::Test {
  protected:
    Modules() {
        std::string name = (fs::temp_directory_path() / "beamcam-modules-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
        folder_ = name;
        unsetenv("BEAMCAM_MODULE_DIR");
    }
    ~Modules() override {
        unsetenv("BEAMCAM_MODULE_DIR");
        fs::remove_all(folder_);
    }
    fs::path folder_;
};

TEST_F(Modules, AreLookedForInTheInstalledPlacesOnly) {
    const auto places = module_places("/opt/x/bin/beamcam", "m.so");
    ASSERT_EQ(places.size(), 2U);
    EXPECT_TRUE(places[0].string().starts_with("/opt/x/lib")) << places[0];
    // A program in another folder, or without /proc: the configured folder.
    EXPECT_EQ(module_places(folder_ / "beamcam", "m.so"), std::vector<fs::path>{places[1]});
    EXPECT_EQ(module_places(folder_ / "tests/test_x", "m.so"), std::vector<fs::path>{places[1]});
    EXPECT_EQ(module_places({}, "m.so"), std::vector<fs::path>{places[1]});
    EXPECT_TRUE(places[1].is_absolute());
}

TEST_F(Modules, OfABuildFolderBelongToItsPrograms) {
    std::ofstream(folder_ / "CMakeCache.txt") << "#";
    const fs::path place = module_places(folder_ / "beamcam", "m.so").front();
    EXPECT_TRUE(place.string().starts_with((folder_ / "lib").string())) << place;
    EXPECT_EQ(module_places(folder_ / "tests/test_x", "m.so").front(), place);
}

TEST_F(Modules, OfAnotherBuildAreRefused) {
    // A valid library without the entry function.
    for (const char* libm : {"/lib/x86_64-linux-gnu/libm.so.6", "/lib/aarch64-linux-gnu/libm.so.6", "/lib64/libm.so.6"})
        if (fs::exists(libm) && !fs::exists(folder_ / "m.so")) fs::copy_file(libm, folder_ / "m.so");
    if (!fs::exists(folder_ / "m.so")) GTEST_SKIP() << "no library to take for a module";
    setenv("BEAMCAM_MODULE_DIR", folder_.c_str(), 1);
    try {
        load_module("m.so");
        FAIL() << "taken";
    } catch (const ModuleError& error) {
        EXPECT_NE(std::string(error.what()).find("belongs to another build"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace beamcam::render
