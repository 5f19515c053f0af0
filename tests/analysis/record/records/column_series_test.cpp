// Columns of tables and of HDF5 files as series in SI units.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "analysis/record/records/dataset_file.hpp"
#include "analysis/record/records/raw_series.hpp"
#include "core/failure/failure.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::testing {
namespace {

using records::RawSeries;
using records::SeriesChoice;

SeriesChoice columns(const std::vector<std::string>& texts) {
  SeriesChoice choice;
  for (const std::string& text : texts) {
    const records::ParsedMapping parsed = records::parse_mapping(text);
    EXPECT_EQ(parsed.fault, "");
    choice.columns.push_back(parsed.mapping);
  }
  EXPECT_EQ(records::contradiction_in(choice), "");
  return choice;
}

class ColumnSeries : public ::testing::Test {
 protected:
  std::vector<RawSeries> all(const std::string& text, const SeriesChoice& choice) {
    return records::read_columns(tables::TextTable(folder_.write("log.txt", text)), choice);
  }
  RawSeries one(const std::string& text, const SeriesChoice& choice) {
    const std::vector<RawSeries> found = all(text, choice);
    EXPECT_EQ(found.size(), 1u);
    return found.front();
  }
  /// The message with which the file is refused, without the file's name, with which it must begin.
  template <class Read>
  std::string refusal_of(const std::string& file, const Read& read) {
    try {
      read();
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::bad_input) << failure.what();
      const std::string message = failure.what();
      const std::string name = (folder_ / file).string() + ": ";
      EXPECT_TRUE(message.starts_with(name)) << message;
      return message.substr(std::min(message.size(), name.size()));
    }
    return "not refused";
  }
  std::string refusal(const std::string& text, const SeriesChoice& choice) {
    return refusal_of("log.txt", [&] { all(text, choice); });
  }

  TemporaryFolder folder_;
};

TEST_F(ColumnSeries, MappedColumnsAreConvertedToSiUnits) {
  const RawSeries series = one("zeit;strom;weg\n0,0;0,5;20\n1,0;-1;30\n",
                               columns({"time=zeit[ms]", "torque=strom[A]*0.87", "angle=weg[mm]/10"}));
  EXPECT_EQ(series.time, (std::vector<double>{0.0, 1e-3}));
  EXPECT_EQ(series.torque, (std::vector<double>{0.87 * 0.5, -0.87}));
  EXPECT_DOUBLE_EQ(series.angle[0], 2.0);
  EXPECT_DOUBLE_EQ(series.angle[1], 3.0);
  EXPECT_EQ(series.torque_kind, records::TorqueKind::commanded);
  EXPECT_FALSE(series.linear);
}

TEST_F(ColumnSeries, TheUnitComesFromTheMappingThenTheHeaderThenSi) {
  const std::string text = "time [ms],torque (mN m),theta\n1,2,3\n";
  const RawSeries by_header = one(text, {});
  EXPECT_EQ(by_header.time[0], 1e-3);
  EXPECT_EQ(by_header.torque[0], 2e-3);
  EXPECT_EQ(by_header.angle[0], 3.0);
  EXPECT_EQ(one(text, columns({"time=time[us]"})).time[0], 1e-6);
  EXPECT_EQ(one(text, columns({"time=time"})).time[0], 1e-3);
  // A factor beside a unit of the quantity's own dimension: a gear.
  EXPECT_DOUBLE_EQ(one(text, columns({"torque=torque[mN m]*50"})).torque[0], 0.1);
}

TEST_F(ColumnSeries, CountsStayWholeNumbersOfKnownResolution) {
  const RawSeries series = one("t,u,enc\n0,0,-7\n1,0,8\n", columns({"torque=u", "angle=enc[count]*1e-6"}));
  EXPECT_EQ(series.angle, (std::vector<double>{-7, 8}));
  EXPECT_DOUBLE_EQ(series.count_size, 1e-6);
  const RawSeries turned = one("t,u,enc\n0,0,-7\n1,0,8\n", columns({"torque=u", "angle=enc[count]*-1e-6"}));
  EXPECT_EQ(turned.angle, (std::vector<double>{7, -8}));
  SeriesChoice choice = columns({"torque=u", "angle=enc[count]"});
  choice.count_size = 1e-3;
  EXPECT_EQ(one("t,u,enc\n0,0,-7\n1,0,8\n", choice).count_size, 1e-3);
}

// Without a unit, whole numbers are counts if their size is given, and nothing otherwise.
TEST_F(ColumnSeries, AnAngleWithoutAUnitIsNeverGuessed) {
  const std::string counts = "t,M,pos\n0,1,5\n1,1,7\n2,1,-3\n";
  SeriesChoice sized = columns({"torque=M[N m]", "angle=pos"});
  sized.count_size = 1e-3;
  const RawSeries series = one(counts, sized);
  EXPECT_EQ(series.count_size, 1e-3);
  EXPECT_EQ(series.angle, (std::vector<double>{5.0, 7.0, -3.0}));
  EXPECT_NE(
      refusal(counts, columns({"torque=M[N m]", "angle=pos"})).find("expected --column 'angle=pos[count]'"),
      std::string::npos);
  const std::string rad = "t,M,pos\n0,1,0.5\n1,1,0.75\n2,1,-3\n";
  EXPECT_NE(refusal(rad, sized).find("is not in counts"), std::string::npos);
  EXPECT_EQ(one(rad, columns({"torque=M[N m]", "angle=pos"})).angle[1], 0.75);
  // The header's unit decides, too.
  EXPECT_EQ(one("t,M,pos [mrad]\n0,1,5\n1,1,7\n", sized).count_size, 0.0);
}

TEST_F(ColumnSeries, ALinearAxisHasForceAndPosition) {
  const RawSeries series =
      one("t,u,enc\n0,2,-7\n1,3,8\n", columns({"drive_force=u[V]*35.15", "position=enc[count]*2e-6"}));
  EXPECT_TRUE(series.linear);
  EXPECT_EQ(series.torque[0], 70.3);
  EXPECT_EQ(series.angle[1], 8.0);
  EXPECT_DOUBLE_EQ(series.count_size, 2e-6);
  EXPECT_EQ(series.torque_kind, records::TorqueKind::motor);
}

TEST_F(ColumnSeries, ARecordWithoutTimesHasASamplingInterval) {
  SeriesChoice choice = columns({"torque=#1", "angle=#2[rad]"});
  choice.sample_time = 0.5;
  EXPECT_EQ(one("1 2\n3 4\n5 6\n", choice).time, (std::vector<double>{0.0, 0.5, 1.0}));
}

TEST_F(ColumnSeries, RepetitionsBeginWhereTheTimeStartsAgain) {
  std::string text = "t,torque,theta\n";
  for (int repetition = 0; repetition < 3; ++repetition) {
    for (int k = 0; k < 200; ++k) text += fmt::format("{},{},{}\n", 1 + k, repetition, 200 * repetition + k);
  }
  const std::vector<RawSeries> parts = all(text, {});
  ASSERT_EQ(parts.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(parts[i].name, (folder_ / "log.txt").string() + fmt::format(", repetition {}", i + 1));
    EXPECT_EQ(parts[i].time.size(), 200u);
    EXPECT_EQ(parts[i].time[0], 1.0);
    EXPECT_EQ(parts[i].torque[5], static_cast<double>(i));
    EXPECT_EQ(parts[i].angle[5], 200.0 * static_cast<double>(i) + 5.0);
    EXPECT_EQ(records::place_of(parts[i], 3),
              (folder_ / "log.txt").string() + fmt::format(":{}", 200 * i + 5));
  }
  // A time that falls back by a little is a fault of the time, which the checks of the record name.
  EXPECT_EQ(all("t,torque,theta\n0,0,0\n1,0,0\n2,0,0\n1.5,0,0\n3,0,0\n", {}).size(), 1u);
}

TEST_F(ColumnSeries, RepetitionsBeginWhereTheirColumnChanges) {
  const std::vector<RawSeries> parts = all(
      "t,torque,theta,cycle\n0,0,0,7\n1,0,1,7\n2,0,2,9\n3,0,3,9\n4,0,4,9\n", columns({"repetition=cycle"}));
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].angle, (std::vector<double>{0, 1}));
  EXPECT_EQ(parts[1].angle, (std::vector<double>{2, 3, 4}));
}

TEST_F(ColumnSeries, ColumnsThatDoNotFitAreNamed) {
  const std::string text = "t,i [A],x [mm],y [furlong],torque,theta\n0,1,2,3,4,5\n";
  EXPECT_EQ(refusal(text, columns({"torque=current"})),
            "has no column 'current'; its columns are t, i, x, y, torque, theta");
  for (const std::string column : {"i*0.87", "i/10", "i * 2 / 3"}) {
    EXPECT_EQ(refusal(text, columns({"torque=" + column})),
              "has no column '" + column +
                  "'; its columns are t, i, x, y, torque, theta; factors stand after a unit, as in "
                  "current[A]*0.87");
  }
  EXPECT_EQ(refusal(text, columns({"torque=i/amplifier"})),
            "has no column 'i/amplifier'; its columns are t, i, x, y, torque, theta");
  EXPECT_EQ(refusal(text, columns({"torque=i"})),
            "column 'i' is in A, which cannot be converted to torque without a factor; expected --column "
            "'torque=i[A]*FACTOR'");
  EXPECT_EQ(refusal(text, columns({"angle=x"})),
            "column 'x' is in mm, which cannot be converted to angle without a factor; expected --column "
            "'angle=x[mm]*FACTOR'");
  EXPECT_EQ(refusal(text, columns({"time=x[m]"})),
            "column 'x' is in m, which cannot be converted to time without a factor; expected --column "
            "'time=x[m]*FACTOR'");
  EXPECT_NE(
      refusal(text, columns({"angle=y"})).find("'furlong', which is not a known unit; expected one of s, ms"),
      std::string::npos);
  EXPECT_EQ(refusal("a,b\n1,2\n", {}),
            "has no column for the torque; expected drive_torque or torque, or --column torque=COLUMN; its "
            "columns are a, b");
  EXPECT_NE(refusal("a,,c\n1,2,3\n", {}).find("its columns are a, #2, c"), std::string::npos);
  EXPECT_EQ(refusal("t,torque,count\n1,2,3\n", {}),
            "the angle is in counts; --counts-per-revolution is missing");
}

// As drives and oscilloscopes write them.
TEST_F(ColumnSeries, AnUnknownUnitIsNamedWhereverItStands) {
  const std::string known = "time (ms);pos act (inc);I act (A)\n0,0;-7;1,5\n1,0;8;2,5\n";
  SeriesChoice choice = columns({"time=time", "torque=I act[A]*0.12", "angle=pos act"});
  choice.count_size = 1e-3;
  EXPECT_EQ(one(known, choice).angle, (std::vector<double>{-7, 8}));
  EXPECT_EQ(one(known, choice).count_size, 1e-3);
  for (const std::string header :
       {"time (ms);pos act (wug);I act (A)\n", "time (ms);pos act [wug];I act (A)\n",
        "time;pos act;I act\nms;wug;A\n", "time;pos act;I act\n(ms);(wug);(A)\n"}) {
    EXPECT_NE(refusal(header + "0;-7;1\n1;8;2\n", choice)
                  .find("column 'pos act' is in 'wug', which is not a known unit; expected one of s, ms"),
              std::string::npos)
        << header;
    SeriesChoice said = columns({"time=time", "torque=I act[A]*0.12", "angle=pos act[count]"});
    said.count_size = 1e-3;
    EXPECT_EQ(one(header + "0;-7;1\n1;8;2\n", said).angle, (std::vector<double>{-7, 8})) << header;
  }
}

TEST_F(ColumnSeries, OptionsThatContradictEachOtherAreRefused) {
  const auto contradiction = [](const std::vector<std::string>& texts, SeriesChoice choice = {}) {
    for (const std::string& text : texts) choice.columns.push_back(records::parse_mapping(text).mapping);
    return records::contradiction_in(choice);
  };
  EXPECT_EQ(contradiction({"time=a", "time=b"}), "'--column time=…' is given twice");
  EXPECT_NE(contradiction({"torque=a", "drive_torque=b"}), "");
  EXPECT_NE(contradiction({"force=a"}), "");
  EXPECT_NE(contradiction({"force=a", "angle=b"}), "");
  EXPECT_EQ(contradiction({"force=a", "position=b", "time=c"}), "");
  SeriesChoice choice;
  choice.torque = "torque";
  EXPECT_NE(contradiction({"torque=a"}, choice), "");
  choice = {};
  choice.sample_time = 1.0;
  EXPECT_NE(contradiction({"time=a"}, choice), "");
}

class Datasets : public ColumnSeries {
 protected:
  /// A file written by h5py, as MATLAB writes version 7.3: a user block, matrices transposed.
  void SetUp() override {
    const std::string script = folder_
                                   .write("write.py",
                                          "import sys, h5py, numpy\n"
                                          "f = h5py.File(sys.argv[1], 'w', userblock_size=512)\n"
                                          "f['t'] = numpy.arange(5.0).reshape(1, 5)\n"
                                          "f.create_dataset('group/i', data=numpy.arange(5, dtype='>i2')"
                                          ".reshape(5, 1), chunks=True, compression='gzip')\n"
                                          "f['all'] = numpy.arange(15, dtype='f4').reshape(3, 5)\n"
                                          "f['rows'] = numpy.arange(15.0).reshape(5, 3)\n"
                                          "f['flat'] = numpy.arange(5, dtype='u1')\n"
                                          "f['short'] = numpy.arange(4.0)\n"
                                          "f['bad'] = numpy.array([0, 1, numpy.nan, 3, 4])\n"
                                          "f['word'] = 'a machine'\n"
                                          "f['cube'] = numpy.zeros((2, 2, 2))\n")
                                   .string();
    const std::string command = ZEROCOUNT_PYTHON " '" + script + "' '" + (folder_ / "log.mat").string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
  }
  RawSeries read(const std::vector<std::string>& texts) {
    return records::read_columns(records::DatasetFile(folder_ / "log.mat"), columns(texts)).front();
  }
  std::string mat_refusal(const std::vector<std::string>& texts) {
    return refusal_of("log.mat", [&] { read(texts); });
  }
};

TEST_F(Datasets, VectorsOfAnyTypeAndShapeAreRead) {
  const RawSeries series = read({"time=/t[ms]", "torque=/group/i[mA]*2", "angle=flat[mrad]"});
  EXPECT_EQ(series.time, (std::vector<double>{0, 1e-3, 2e-3, 3e-3, 4e-3}));
  EXPECT_EQ(series.torque, (std::vector<double>{0, 2, 4, 6, 8}));
  EXPECT_EQ(series.angle[4], 4e-3);
  EXPECT_EQ(records::place_of(series, 3), (folder_ / "log.mat").string() + ", sample 3");
}

TEST_F(Datasets, RowsOfAMatrixAreNumbered) {
  EXPECT_EQ(read({"time=/t", "torque=/all#2", "angle=/all#3[rad]"}).torque,
            (std::vector<double>{5, 6, 7, 8, 9}));
  EXPECT_EQ(read({"time=/t", "torque=/rows#2", "angle=/all#3[rad]"}).torque,
            (std::vector<double>{1, 4, 7, 10, 13}));
}

TEST_F(Datasets, DatasetsThatDoNotFitAreNamed) {
  for (const std::string column :
       {"/none", "/group", "/word", "/cube", "/all", "/all#4", "/all#0", "/all#x"}) {
    EXPECT_EQ(
        mat_refusal({"time=/t", "torque=" + column, "angle=/flat"}),
        "has no column '" + column +
            "'; its columns are /all (3×5), /bad (5), /cube (2×2×2), /flat (5), /group/i (5×1), /rows (5×3), "
            "/short (4), /t (1×5)");
  }
  EXPECT_EQ(mat_refusal({"time=/t", "torque=/short", "angle=/flat[rad]"}),
            "time, torque and angle have 5, 4 and 5 samples; expected as many of each");
  try {
    read({"time=/t", "torque=/bad", "angle=/flat"});
    ADD_FAILURE();
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_data);
    EXPECT_NE(std::string(failure.what()).find("/bad: element 2 is not a finite number"), std::string::npos);
  }
}

// h5py compresses with lzf where one asks for speed, and the HDF5 library does not have this filter.
TEST_F(Datasets, AnUnknownFilterIsNamedWithItsRemedy) {
  const std::string script =
      folder_
          .write("filter.py",
                 "import sys, h5py, numpy\n"
                 "f = h5py.File(sys.argv[1], 'w')\n"
                 "for name in ('t', 'i'): f[name] = numpy.arange(500.0)\n"
                 "f.create_dataset('x', data=numpy.arange(500.0), chunks=True, compression='lzf')\n")
          .string();
  const std::string command = ZEROCOUNT_PYTHON " '" + script + "' '" + (folder_ / "lzf.h5").string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  try {
    records::read_columns(records::DatasetFile(folder_ / "lzf.h5"),
                          columns({"time=/t", "torque=/i", "angle=/x[rad]"}));
    ADD_FAILURE();
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_data);
    const std::string said = failure.what();
    EXPECT_NE(said.find("/x is stored through the HDF5 filter lzf"), std::string::npos) << said;
    EXPECT_NE(said.find("h5repack -f GZIP=1"), std::string::npos) << said;
    EXPECT_EQ(said.find("damaged"), std::string::npos) << said;
  }
}

// A trace says where the axis slides. A logger may call something else its mode.
TEST_F(ColumnSeries, OnlyTheModeColumnOfATraceFlagsSliding) {
  const RawSeries trace = one("t,torque,theta,mode\n0,1,0,stick\n1,1,1,slide\n2,1,3,slide\n", {});
  EXPECT_EQ(trace.sliding, (std::vector<bool>{false, true, true}));
  EXPECT_TRUE(one("t,torque,theta,mode\n0,1,0,auto\n1,1,1,auto\n", {}).sliding.empty());
  EXPECT_TRUE(one("t,torque,theta,mode\n0,1,0,stick\n1,1,1,1\n", {}).sliding.empty());
}

/// A table of whole counts, with a header.
std::string table_of(const std::vector<double>& counts, bool newest_first) {
  std::vector<std::string> rows;
  for (std::size_t k = 0; k < counts.size(); ++k)
    rows.push_back(
        fmt::format("{},{},{}\n", 1e-3 * static_cast<double>(k), 0.1 * static_cast<double>(k), counts[k]));
  if (newest_first) std::reverse(rows.begin(), rows.end());
  std::string text = "t,torque,count\n";
  for (const std::string& row : rows) text += row;
  return text;
}

// Random walks of an encoder, read modulo a revolution or a word of the counter.
TEST_F(ColumnSeries, AWrappingCounterIsUnwrappedWithANote) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 30; ++i) {
    SeriesChoice choice;
    const double revolution = std::floor(std::exp(std::uniform_real_distribution<double>(6.0, 12.0)(random)));
    choice.count_size = 2.0 * std::numbers::pi / revolution;
    const double wrap = i % 3 == 0 ? 65536.0 : revolution;
    const double low = i % 2 == 0 ? 0.0 : -std::floor(0.5 * wrap);
    std::vector<double> truth{std::floor(std::uniform_real_distribution<double>(low, low + wrap)(random))};
    double speed = 0.0;
    for (int k = 0; k < 2000; ++k) {
      speed = 0.99 * speed + std::normal_distribution<double>(0.0, 2e-3 * wrap)(random);
      truth.push_back(truth.back() + std::round(std::clamp(speed, -0.1 * wrap, 0.1 * wrap)));
    }
    std::vector<double> read;
    for (const double count : truth) read.push_back(count - wrap * std::floor((count - low) / wrap));
    const RawSeries series = one(table_of(read, false), choice);
    const bool wraps = read != truth;
    ASSERT_EQ(series.notes.size(), wraps ? 1u : 0u) << i;
    for (std::size_t k = 0; k < truth.size(); ++k)
      ASSERT_EQ(series.angle[k] - series.angle[0], truth[k] - truth[0]) << i << ", " << k;
    if (wraps) {
      EXPECT_NE(series.notes[0].find(fmt::format("jumps by {:.6g} counts", wrap)), std::string::npos)
          << series.notes[0];
    }
  }
}

TEST_F(ColumnSeries, RowsInReverseOrderAreReversedWithANote) {
  const std::vector<double> counts{3, 5, 6, 6, 4, 1};
  SeriesChoice choice;
  choice.count_size = 1e-3;
  const RawSeries usual = one(table_of(counts, false), choice);
  const RawSeries newest_first = one(table_of(counts, true), choice);
  EXPECT_EQ(newest_first.time, usual.time);
  EXPECT_EQ(newest_first.torque, usual.torque);
  EXPECT_EQ(newest_first.angle, usual.angle);
  EXPECT_EQ(newest_first.lines, (std::vector<std::size_t>{7, 6, 5, 4, 3, 2}));
  EXPECT_TRUE(usual.notes.empty());
  ASSERT_EQ(newest_first.notes.size(), 1u);
  EXPECT_NE(newest_first.notes[0].find("newest first"), std::string::npos);
}

}  // namespace
}  // namespace zerocount::testing
