// Trials as earlier versions of this program drew them: a manifest has the same trials for ever.
#include "experiments/manifest/load_study.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/test.hpp"

namespace zerocount::study {
namespace {

struct RecordedTrial {
  const char* design;
  const char* independent;
  std::int64_t point;
  std::int64_t index;
  std::vector<double> inputs;  // of full_manifest()
};

const std::vector<RecordedTrial> recorded{
    RecordedTrial{"monte_carlo",
                  "false",
                  5,
                  123,
                  {0.0006, 102.73966471368907, 862.6947079910299, 199846.89937849462, 0.9262956628696883,
                   0.2870621690814896, 0.0003, 3.85e-05, 1, 0, 13, 0.9842529855420333, 1.9148335932385823,
                   -0.003934104920719751}},
    RecordedTrial{"monte_carlo",
                  "false",
                  11,
                  999,
                  {0.0006, 98.47908829134342, 882.38253005278, 221451.4258251076, 0.12067245737154708,
                   0.29151022070450777, 0.0003, 9.45e-05, 1, 1, 19, 0.6838954054432377, 1.6462506014176337,
                   0.00692129817852626}},
    RecordedTrial{"monte_carlo",
                  "true",
                  5,
                  123,
                  {0.0006, 102.38715464284829, 760.264917972189, 231102.75117982432, 0.5391536387604396,
                   0.2707031335128402, 0.0003, 3.85e-05, 0, 0, 21, 0.8609043332912297, 1.9026048299981797,
                   -0.013726746076024378}},
    RecordedTrial{"monte_carlo",
                  "true",
                  11,
                  999,
                  {0.0006, 102.63899994467624, 631.8260501641521, 211414.22350076557, 0.24770496405093584,
                   0.2946821349680618, 0.0003, 9.45e-05, 1, 1, 17, 0.029341355185455886, 1.216048996722621,
                   -0.015143731549369672}},
    RecordedTrial{"latin_hypercube",
                  "false",
                  5,
                  123,
                  {0.0006, 125.51520008342595, 608.662694707991, 181446.0485423161, 0.5799229915750018,
                   0.3124683280998171, 0.0003, 3.85e-05, 0, 0, 3, 0.308984252985542, 3.017895583835117,
                   0.014400730996470384}},
    RecordedTrial{"latin_hypercube",
                  "false",
                  11,
                  999,
                  {0.0006, 111.42463661288284, 673.7823825300528, 150950.41071969437, 0.5226971904931184,
                   0.311812608080977, 0.0003, 9.45e-05, 0, 1, 20, 0.9206838954054432, 4.2377084531248865,
                   -7.733468935505313e-05}},
    RecordedTrial{"latin_hypercube",
                  "true",
                  5,
                  123,
                  {0.0006, 109.85426956792803, 691.6602649179722, 204299.8245195353, 1.0743541582877811,
                   0.3000042863811031, 0.0003, 3.85e-05, 1, 0, 3, 0.2988609043332912, 2.6069363470171187,
                   -0.0014873038264617494}},
    RecordedTrial{"latin_hypercube",
                  "true",
                  11,
                  999,
                  {0.0006, 112.13370616160798, 610.5318260501641, 168035.00367087516, 0.6489879781473471,
                   0.3073619476662606, 0.0003, 9.45e-05, 0, 1, 22, 0.25302934135518546, 1.5392149200600265,
                   -0.011143719909553243}},
    RecordedTrial{"sobol",
                  "false",
                  5,
                  123,
                  {0.0006, 107.17311418988021, 868.685033747184, 220262.2652026604, 0.13706812248423986,
                   0.30904352555071607, 0.0003, 3.85e-05, 1, 0, 7, 0.828789189088421, 3.103800852904933,
                   0.002896815098522083}},
    RecordedTrial{"sobol",
                  "false",
                  11,
                  999,
                  {0.0006, 106.97064664450411, 833.821752497184, 148161.57689504637, 1.8041791251928307,
                   0.2805756747789015, 0.0003, 9.45e-05, 1, 1, 6, 0.933281376588421, 0.4379951124429402,
                   -0.0117995158303741}},
    RecordedTrial{"sobol",
                  "true",
                  5,
                  123,
                  {0.0006, 102.16689903087729, 603.3434711997465, 198672.42602388322, 0.6166241677898523,
                   0.28476171643411896, 0.0003, 3.85e-05, 0, 0, 22, 0.3898628018315099, 3.554523902208499,
                   -0.007732407514590065}},
    RecordedTrial{"sobol",
                  "true",
                  11,
                  999,
                  {0.0006, 103.07437343609088, 654.2352425616317, 230027.5299807256, 0.13207616787623336,
                   0.3208465229647221, 0.0003, 9.45e-05, 0, 1, 28, 0.265554847851707, 3.6807255806140335,
                   -0.0054889743628648395}},
};

TEST(RecordedTrials, HaveTheSameInputs) {
  for (const RecordedTrial& r : recorded) {
    const Study study = study_of(full_manifest(), {std::string("design=") + r.design,
                                                   std::string("independent_points=") + r.independent});
    EXPECT_EQ(study_trial(study, r.point, r.index).inputs, r.inputs)
        << r.design << " " << r.independent << " " << r.point << " " << r.index;
  }
}

std::vector<double> shipped_inputs(const char* name, std::int64_t point, std::int64_t index) {
  const auto path = std::filesystem::path(ZEROCOUNT_MANIFESTS) / (std::string(name) + ".yaml");
  return study_trial(manifest::load_study(path), point, index).inputs;
}

TEST(RecordedTrials, OfTheShippedStudiesAreTheSame) {
  using Inputs = std::vector<double>;
  EXPECT_EQ(shipped_inputs("creep", 1, 7), (Inputs{0.2108899526916283, 23.639586923168828, 1.5340186057656258,
                                                   0.035149372941878476, 0.0001}));
  EXPECT_EQ(shipped_inputs("k1-along-position", 1, 7),
            (Inputs{118.88763563827634, 6.5e-05, 28, 0.31842490501536896, 1.1268523423094954}));
  EXPECT_EQ(shipped_inputs("paper-fig7", 3, 7),
            (Inputs{95.47576209027036, 624.3800633036569, 4, 0.03333802305877931}));
  EXPECT_EQ(shipped_inputs("paper-fig8", 0, 7),
            (Inputs{111.80694861622081, 844.6662162896077, 0.7808370290590104, 11.063815572050062,
                    0.9881605140557418}));
  EXPECT_EQ(shipped_inputs("paper-gains", 3, 7),
            (Inputs{121.11823564271323, 113.50472154229266, 957.1078811449353, 88940.46226870158,
                    0.4125754549647488, 17.717219610312732, 1.9555178501386972, 0, 0.000208, 25,
                    0.3200862443096518, 5.357569270688762, 2.0090982157634843e-05, -0.0033703985796195712}));
  EXPECT_EQ(shipped_inputs("stability-map", 3, 7),
            (Inputs{119.39529652293292, 774.7119466374252, 0, 3.64112840605216e-05, 3, 0.5107224245775027}));
}

}  // namespace
}  // namespace zerocount::study
