// Records of motions (peer_records.hpp: tables S1b, S2, S3).
#pragma once

namespace bench {

void print_chain_records();
void print_fourbar_records();
void print_squeezer_records();

}  // namespace bench
