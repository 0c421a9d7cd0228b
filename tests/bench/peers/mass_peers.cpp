#include "shapeid/tests/bench/peers/mass_peer.hpp"

namespace shapeid::bench {

const std::vector<PeerKind>& mass_peers() {
  static const std::vector<PeerKind> peers = [] {
    std::vector<PeerKind> all;
    add_fast(all);
    add_reference(all);
    add_lawson_hanson(all);
    add_ceres(all);
#ifdef SHAPEID_QPOASES
    add_qpoases(all);
#endif
#ifdef SHAPEID_PROXQP
    add_proxqp(all);
#endif
#ifdef SHAPEID_PIQP
    add_piqp(all);
#endif
#ifdef SHAPEID_EIGEN_NNLS
    add_eigen_nnls(all);
#endif
    return all;
  }();
  return peers;
}

const std::vector<std::string>& missing_peers() {
  static const std::vector<std::string> missing = {
#ifndef SHAPEID_QPOASES
      "qpoases",
#endif
#ifndef SHAPEID_PROXQP
      "proxqp",
#endif
#ifndef SHAPEID_PIQP
      "piqp",
#endif
#ifndef SHAPEID_EIGEN_NNLS
      "eigen_nnls",
#endif
#ifndef SHAPEID_PINOCCHIO
      "pinocchio",
#endif
  };
  return missing;
}

}  // namespace shapeid::bench
