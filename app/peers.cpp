#include "shapeid/app/peers.hpp"

#include "shapeid/models/contract.hpp"

namespace shapeid::app {

void Alone::send(const std::string& /*bytes*/, std::size_t /*to*/) {
  throw Defect("one process alone has nobody to send to");
}

std::string Alone::receive(std::size_t /*from*/) {
  throw Defect("one process alone has nobody to receive from");
}

}  // namespace shapeid::app
