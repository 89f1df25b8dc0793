#pragma once

namespace canyon::testing {

/// A building of 10 m at 35.54 degrees north, latitude first: its walls are left out, its roof and its floor are not.
inline constexpr const char* kOneBuildingCityGml =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<core:CityModel xmlns:core="c" xmlns:bldg="b" xmlns:gml="g"><gml:boundedBy><gml:Envelope srsName="http://www.opengis.net/def/crs/EPSG/0/6697"/></gml:boundedBy>
<core:cityObjectMember><bldg:Building gml:id="B1"><bldg:lod0RoofEdge><gml:Polygon><gml:exterior><gml:LinearRing>
<gml:posList>35.54 139.77 0 35.54 139.7701 0 35.5401 139.7701 0</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></bldg:lod0RoofEdge>
<bldg:lod1Solid><gml:Solid><gml:Polygon><gml:exterior><gml:LinearRing>
<gml:posList>35.54 139.77 3 35.5401 139.77 3 35.5401 139.7701 3 35.54 139.7701 3 35.54 139.77 3</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon>
<gml:Polygon><gml:exterior><gml:LinearRing>
<gml:posList>35.54 139.77 13 35.54 139.7701 13 35.5401 139.7701 13 35.5401 139.77 13 35.54 139.77 13</gml:posList></gml:LinearRing></gml:exterior></gml:Polygon></gml:Solid></bldg:lod1Solid>
</bldg:Building></core:cityObjectMember></core:CityModel>)";

}  // namespace canyon::testing
