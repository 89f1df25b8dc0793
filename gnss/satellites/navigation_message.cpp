#include "canyon/gnss/satellites/navigation_message.h"

namespace canyon::gnss {

NavigationMessage beidou_message(int prn) {
  return prn <= 5 || prn >= 59 ? NavigationMessage::kD2 : NavigationMessage::kD1;
}

const char* name_of(NavigationMessage message) {
  switch (message) {
    case NavigationMessage::kLnav:
      return "LNAV";
    case NavigationMessage::kCnav:
      return "CNAV";
    case NavigationMessage::kCnav2:
      return "CNV2";
    case NavigationMessage::kInav:
      return "INAV";
    case NavigationMessage::kFnav:
      return "FNAV";
    case NavigationMessage::kD1:
      return "D1";
    case NavigationMessage::kD2:
      return "D2";
    case NavigationMessage::kBcnav1:
      return "CNV1";
    case NavigationMessage::kBcnav2:
      return "CNV2";
    case NavigationMessage::kFdma:
      return "FDMA";
    case NavigationMessage::kAlmanac:
      return "ALMANAC";
  }
  return "";
}

}  // namespace canyon::gnss
