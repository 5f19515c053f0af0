// Pages come before the names of C++ and Python that contain the word.
var Scorer = {
  objNameMatch: 4, objPartialMatch: 1, objPrio: { 0: 2, 1: 0, 2: -2 }, objPrioDefault: 0,
  title: 15, partialTitle: 9, term: 6, partialTerm: 2,
};
