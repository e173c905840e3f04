-- SPDX-License-Identifier: Apache-2.0
-- Shows the recordings of deltamap in Wireshark and tshark: ARCOS packets of the interface `robot` (USER0) and LMS2xx
-- telegrams of the interface `laser` (USER1), by name and field, put together across chunks and for each direction by
-- itself, and the notes (comments of packets) beside them. "A6", "B4": sections of arcos.md and lms200.md.
--
-- Frames are found as deltamap's decoders find them, so that both count alike: what is no frame is `garbage`.
-- Filters: arcos.name == "SIP", arcos.sip.x, lms2xx.name == "scan", lms2xx.garbage, deltamap.note contains "paused".

local bit = rawget(_G, "bit") or rawget(_G, "bit32")
local bxor, band, rshift = bit.bxor, bit.band, bit.rshift

local IN, OUT = 1, 2 -- from the device, to it
local LONGEST_PAUSE_IN_FRAME_S = 0.25
local PAUSE_BETWEEN_TELEGRAMS_S = 0.03 -- longer than the 14 ms that a laser may pause inside a telegram (B1)

local arcos = Proto("arcos", "ARCOS (Pioneer robot)")
local lms = Proto("lms2xx", "SICK LMS2xx telegrams")
local notes = Proto("deltamap", "deltamap's notes")

local f_note = ProtoField.string("deltamap.note", "Note")
notes.fields = { f_note }

-- Fields of a protocol: made from "name" = {kind, "Label"}, kept by name.
local function declare(proto, prefix, kinds)
  local made, list = {}, {}
  for name, kind in pairs(kinds) do
    made[name] = ProtoField[kind[1]](prefix .. "." .. name, kind[2], kind[3], kind[4])
    list[#list + 1] = made[name]
  end
  proto.fields = list
  return made
end

local a = declare(arcos, "arcos", {
  name = { "string", "Packet" }, count = { "uint8", "Byte count", base.DEC }, type = { "uint8", "Type", base.HEX },
  command = { "uint8", "Command", base.DEC }, argument = { "int32", "Argument" }, text = { "string", "Text" },
  left = { "int8", "Left" }, right = { "int8", "Right" }, data = { "bytes", "Data" },
  checksum = { "uint16", "Checksum", base.HEX }, garbage = { "bytes", "Garbage" },
  robot_name = { "string", "Name" }, robot_type = { "string", "Robot type" }, robot_subtype = { "string", "Subtype" },
  ["sip.moving"] = { "bool", "Moving" }, ["sip.x"] = { "uint16", "x (units)", base.DEC },
  ["sip.y"] = { "uint16", "y (units)", base.DEC }, ["sip.heading"] = { "int16", "Heading (4096 a turn)", base.DEC },
  ["sip.left"] = { "int16", "Left speed (mm/s)", base.DEC }, ["sip.right"] = { "int16", "Right speed (mm/s)", base.DEC },
  ["sip.battery"] = { "uint8", "Battery (0.1 V)", base.DEC },
  ["sip.left_stall"] = { "bool", "Left motor stalled" }, ["sip.right_stall"] = { "bool", "Right motor stalled" },
  ["sip.rear_bumpers"] = { "uint8", "Rear bumpers", base.HEX }, ["sip.front_bumpers"] = { "uint8", "Front bumpers", base.HEX },
  ["sip.control"] = { "int16", "Heading set point (4096 a turn)", base.DEC }, ["sip.flags"] = { "uint16", "Flags", base.HEX },
  ["sip.motors"] = { "bool", "Motors enabled" }, ["sip.stop_button"] = { "bool", "STOP button" }, ["sip.estall"] = { "bool", "E-stall" },
  ["sip.compass"] = { "uint8", "Compass (2 deg)", base.DEC }, ["sip.sonar_count"] = { "uint8", "Sonar readings", base.DEC },
  ["sip.sonar"] = { "uint16", "Sonar (mm)", base.DEC }, ["sip.gripper"] = { "uint8", "Gripper state", base.HEX },
  ["sip.analog_port"] = { "uint8", "Analog port", base.DEC }, ["sip.analog"] = { "uint8", "Analog value", base.DEC },
  ["sip.digital_in"] = { "uint8", "Digital in", base.HEX }, ["sip.digital_out"] = { "uint8", "Digital out", base.HEX },
  ["sip.battery_x10"] = { "uint16", "Battery (0.1 V, 16 bits)", base.DEC }, ["sip.charge_state"] = { "uint8", "Charge state", base.DEC },
  ["sip.turn_rate"] = { "int16", "Turn rate (0.1 deg/s)", base.DEC }, ["sip.faults"] = { "uint16", "Fault flags", base.HEX },
  ["sip.lateral"] = { "int16", "Lateral speed (mm/s)", base.DEC }, ["sip.temperature"] = { "int8", "Temperature (deg C)", base.DEC },
  ["sip.charge"] = { "uint8", "State of charge (%)", base.DEC }, ["sip.time"] = { "uint32", "Controller time (us)", base.DEC },
  ["sip.flags3"] = { "uint32", "Flags 3", base.HEX },
  ["encoder.left"] = { "int32", "Left ticks" }, ["encoder.right"] = { "int32", "Right ticks" },
  ["gyro.rate"] = { "uint16", "Gyro rate (512: none)", base.DEC }, ["gyro.temperature"] = { "uint8", "Gyro temperature", base.DEC },
  ["io.digital_in"] = { "uint8", "Digital in", base.HEX }, ["io.digital_out"] = { "uint8", "Digital out", base.HEX },
  ["io.analog"] = { "uint16", "Analog", base.DEC }, ["config.text"] = { "string", "Text" }, ["config.number"] = { "int32", "Number" },
})
local a_garbage = ProtoExpert.new("arcos.garbage.expert", "Bytes that belong to no packet", expert.group.UNDECODED, expert.severity.WARN)
local a_short = ProtoExpert.new("arcos.short", "The content ends early", expert.group.MALFORMED, expert.severity.ERROR)
arcos.experts = { a_garbage, a_short }

local l = declare(lms, "lms2xx", {
  name = { "string", "Telegram" }, address = { "uint8", "Address", base.HEX }, length = { "uint16", "Length", base.DEC },
  command = { "uint8", "Command", base.HEX }, response = { "uint8", "Response", base.HEX }, data = { "bytes", "Data" },
  status = { "uint8", "Status byte", base.HEX }, severity = { "uint8", "Severity (0 good … 4 fatal)", base.DEC },
  implausible = { "bool", "Values implausible" }, dirty = { "bool", "Window dirty" },
  crc = { "uint16", "CRC", base.HEX }, garbage = { "bytes", "Garbage" },
  values = { "uint16", "Values", base.DEC }, unit = { "string", "Unit" }, partial = { "bool", "Partial scan" },
  partial_number = { "uint8", "Raster", base.DEC }, word = { "uint16", "Word", base.DEC },
  range = { "double", "Range (m)" },
  scan_index = { "uint8", "Scan index", base.DEC }, telegram_index = { "uint8", "Telegram index", base.DEC },
  mean_of = { "uint8", "Mean of scans", base.DEC }, from = { "uint16", "From value", base.DEC }, to = { "uint16", "To value", base.DEC },
  reflectivity = { "uint8", "Reflectivity", base.DEC },
  accepted = { "bool", "Accepted" }, angle = { "uint16", "Scan angle (deg)", base.DEC },
  resolution = { "uint16", "Resolution (0.01 deg)", base.DEC }, mode = { "uint8", "Mode", base.HEX },
  meaning = { "string", "Meaning" }, password = { "string", "Password" }, text = { "string", "Text" },
  measuring_mode = { "uint8", "Measuring mode", base.HEX }, units = { "string", "Units" },
  blanking = { "uint16", "Blanking (cm)", base.DEC }, availability = { "uint8", "Availability", base.HEX },
  indices = { "bool", "Sends real-time indices" },
  evaluations = { "uint8", "Multiple evaluation", base.DEC }, restart_mode = { "uint8", "Restart mode", base.HEX },
  version = { "string", "Software version" }, operating_mode = { "uint8", "Operating mode", base.HEX },
  fault = { "uint8", "Fault", base.HEX }, pollution = { "uint16", "Pollution", base.DEC },
  motor = { "uint16", "Motor (us per 1/90 turn)", base.DEC }, baud = { "uint32", "Baud", base.DEC },
  permanent = { "bool", "Permanent baud" }, laser_on = { "bool", "Laser on" }, boot_version = { "string", "Boot version" },
  hours = { "uint32", "Hours of operation", base.DEC }, switch_ons = { "uint16", "Switched on", base.DEC },
  error_type = { "uint8", "Error type", base.DEC }, error_number = { "uint8", "Error number", base.DEC },
})
local l_garbage = ProtoExpert.new("lms2xx.garbage.expert", "Bytes that belong to no telegram", expert.group.UNDECODED, expert.severity.WARN)
local l_short = ProtoExpert.new("lms2xx.short", "The content does not fit", expert.group.MALFORMED, expert.severity.ERROR)
lms.experts = { l_garbage, l_short }

-- What the frame was recorded with.
local comments = Field.new("frame.comment")
local interface_name = Field.new("frame.interface_name")
local interface_id = Field.new("frame.interface_id")
local packet_direction = Field.new("frame.packet_flags_direction")

local function direction_of(pinfo)
  local told = packet_direction()
  if told then return told.value == 2 and OUT or IN end
  return pinfo.p2p_dir == 0 and OUT or IN
end

local function notes_of()
  local found = {}
  for _, comment in ipairs({ comments() }) do found[#found + 1] = comment.value end
  return found
end

-- Finding frames ------------------------------------------------------------------------------------------------------

local function arcos_checksum(raw, first, last)
  local sum, i = 0, first
  while i + 1 <= last do
    local high, low = raw:byte(i, i + 1)
    sum = (sum + high * 256 + low) % 65536
    i = i + 2
  end
  if i == last then sum = bxor(sum, raw:byte(i)) end
  return sum
end

local function lms_crc(raw, first, last)
  local crc, before = 0, 0
  for i = first, last do
    local byte = raw:byte(i)
    crc = crc >= 32768 and bxor((crc - 32768) * 2, 0x8005) or crc * 2
    crc = bxor(crc, before * 256 + byte)
    before = byte
  end
  return crc
end

-- A line: one direction of one interface. `bytes` are those that belong to no frame yet.
local function new_line() return { bytes = "", base = 0, newest = 0, in_garbage = false } end

-- Both finders answer the size of the frame that begins the bytes; 0: none does; nil: too few to tell.
local function arcos_frame_size(raw)
  local first, second, count = raw:byte(1, 3)
  if first ~= 0xFA or (second and second ~= 0xFB) then return 0 end
  if not count then return nil end
  if count < 3 or count > 204 then return 0 end
  if #raw < count + 3 then return nil end
  local high, low = raw:byte(count + 2, count + 3)
  return arcos_checksum(raw, 4, count + 1) == high * 256 + low and count + 3 or 0
end

local function lms_frame_size(raw, line, direction)
  local first, address, low, high = raw:byte(1, 4)
  if direction == IN and not line.in_garbage and (first == 0x06 or first == 0x15) then return 1 end
  if first ~= 0x02 then return 0 end
  if not address then return nil end
  if direction == IN and address ~= 0x80 or direction == OUT and address >= 0x80 then return 0 end
  if not high then return nil end
  local length = low + 256 * high
  if length < (direction == IN and 2 or 1) or length > 808 then return 0 end
  if #raw < length + 6 then return nil end
  local crc_low, crc_high = raw:byte(length + 5, length + 6)
  return lms_crc(raw, 1, length + 4) == crc_low + 256 * crc_high and length + 6 or 0
end

-- Takes frames and garbage from the line; `base` counts the bytes before its first one.
local function take(line, direction, size_of, more_may_come, items)
  local garbage = 0
  local function end_garbage()
    if garbage == 0 then return end
    items[#items + 1] = { is_garbage = true, raw = line.bytes:sub(line.done - garbage + 1, line.done), at = line.base + line.done - garbage }
    garbage = 0
  end
  line.done = 0
  while line.done < #line.bytes do
    local rest = line.done == 0 and line.bytes or line.bytes:sub(line.done + 1)
    local size = size_of(rest, line, direction)
    if size == nil and more_may_come then break end
    if size and size > 0 then
      end_garbage()
      items[#items + 1] = { raw = rest:sub(1, size), at = line.base + line.done }
      line.done = line.done + size
      if size > 1 then line.in_garbage = false end
    else
      garbage = garbage + 1
      line.done = line.done + 1
      line.in_garbage = true
    end
  end
  end_garbage()
  line.base = line.base + line.done
  line.bytes = line.bytes:sub(line.done + 1)
end

-- State of a capture: lines by interface and direction, what each packet has completed, the laser's measuring mode.
local lines, completed, modes

local function begin_capture() lines, completed, modes = {}, {}, {} end
arcos.init = begin_capture
lms.init = begin_capture
begin_capture()

local function both_lines(interface)
  lines[interface] = lines[interface] or { [IN] = new_line(), [OUT] = new_line() }
  return lines[interface]
end

local function obey_notes(pair, told)
  for _, note in ipairs(told) do
    local baud = note:match("^baud (%d+)$")
    if baud and baud ~= pair.baud then
      for _, direction in ipairs({ IN, OUT }) do -- what was half received is given up
        local line = pair[direction]
        line.base, line.bytes, line.in_garbage = line.base + #line.bytes, "", false
      end
      pair.baud = baud
    end
  end
end

-- Frames and garbage that this packet completes. Looked for once, in the order of the capture.
local function items_of(tvb, pinfo, interface, size_of, told)
  if completed[pinfo.number] then return completed[pinfo.number] end
  local pair = both_lines(interface)
  local direction = direction_of(pinfo)
  obey_notes(pair, told)
  local items = { direction = direction }
  local line = pair[direction]
  if tvb:len() > 0 then
    local pause = pinfo.abs_ts - line.newest
    if #line.bytes > 0 and pause > LONGEST_PAUSE_IN_FRAME_S then take(line, direction, size_of, false, items) end
    if #line.bytes == 0 and pause > PAUSE_BETWEEN_TELEGRAMS_S then line.in_garbage = false end
    items.chunk = line.base + #line.bytes -- where on the line this packet's bytes begin
    line.bytes = line.bytes .. tvb:raw()
    line.newest = pinfo.abs_ts
    take(line, direction, size_of, true, items)
  end
  items.waiting = #line.bytes
  completed[pinfo.number] = items
  return items
end

-- The bytes of an item: of this packet where all of them are, else of their own.
local function bytes_of(item, items, tvb, title)
  local offset = items.chunk and item.at - items.chunk or -1
  if offset >= 0 and offset + #item.raw <= tvb:len() then return tvb(offset, #item.raw):tvb() end
  return ByteArray.new(item.raw, true):tvb(title)
end

-- Reading fields ------------------------------------------------------------------------------------------------------

-- Reads one field after another; once one does not fit, nothing more is there.
local function reader(tvb, first, last)
  local r = { at = first }
  function r.left() return r.at and last - r.at or 0 end
  function r.range(size)
    if not r.at or r.at + size > last then
      r.at = nil
      return nil
    end
    local range = tvb(r.at, size)
    r.at = r.at + size
    return range
  end
  function r.text() -- up to its NUL
    local rest = r.left() > 0 and tvb:raw(r.at, r.left()) or ""
    local stop = rest:find("\0", 1, true)
    if not stop then
      r.at = nil
      return nil
    end
    return r.range(stop), rest:sub(1, stop - 1)
  end
  -- Adds a little-endian field; answers its range.
  function r.add(tree, field, size)
    local range = r.range(size)
    if range then tree:add_le(field, range) end
    return range
  end
  return r
end

local function flag(tree, field, range, is_set) tree:add(field, range, is_set) end

-- ARCOS ---------------------------------------------------------------------------------------------------------------

local command_names = {
  [0] = "PULSE", [1] = "OPEN", [2] = "CLOSE", [3] = "POLLING", [4] = "ENABLE", [5] = "SETA", [6] = "SETV", [7] = "SETO", [8] = "MOVE",
  [9] = "ROTATE", [10] = "SETRV", [11] = "VEL", [12] = "HEAD", [13] = "DHEAD", [18] = "CONFIG", [19] = "ENCODER", [21] = "RVEL",
  [23] = "SETRA", [26] = "IMU", [28] = "SONAR", [29] = "STOP", [30] = "DIGOUT", [32] = "VEL2", [35] = "ADSEL", [38] = "GYROCALCW",
  [39] = "GYROCALCCW", [40] = "IOREQUEST", [44] = "BUMPSTALL", [47] = "JOYDRIVE", [48] = "SONARCYCLE", [50] = "HOSTBAUD",
  [51] = "AUX1BAUD", [52] = "AUX2BAUD", [53] = "AUX3BAUD", [55] = "ESTOP", [56] = "ESTALL", [57] = "QSTOP", [58] = "GYRO",
  [62] = "BATTERYINFO", [250] = "BATTEST", [253] = "RESET", [255] = "MAINTENANCE",
}
local type_names = {
  [0] = "SYNC0 echo", [1] = "SYNC1 echo", [2] = "SYNC2 echo", [0x9A] = "IMUpac", [0xB0] = "AUX port", [0xB8] = "AUX port",
  [0xC8] = "AUX port", [0xC0] = "compass", [0xE0] = "gripper", [0xF8] = "joystick", [0xFA] = "battery",
}
local kUnknownPacket = "packet of unknown type"

-- Answers the name and what it is asked with, or nothing where the bytes are no command (A3).
local function add_command(tvb, tree, last)
  local r = reader(tvb, 3, last)
  local number = r.range(1)
  local name = command_names[number:uint()] or "command " .. number:uint()
  local detail
  local kind = r.range(1)
  if kind and kind:uint() ~= 0x3B and kind:uint() ~= 0x1B and kind:uint() ~= 0x2B then return nil end
  tree:add(a.command, number)
  if kind and r.left() > 0 then
    if kind:uint() == 0x2B then
      local size = r.range(1):uint()
      local text = size > 0 and r.range(size)
      if text == nil then return nil end
      if text then tree:add(a.data, text) end
      detail = " " .. size .. " bytes"
    else
      local range = r.range(2)
      if not range then return nil end
      local value = range:le_uint() * (kind:uint() == 0x1B and -1 or 1)
      tree:add(a.argument, range, value)
      detail = " " .. value
      if name == "VEL2" or name == "DIGOUT" then -- negated before it is split (A3)
        local pair = value % 65536
        local high, low = rshift(pair, 8), band(pair, 0xFF)
        tree:add(a.left, range, high >= 128 and high - 256 or high)
        tree:add(a.right, range, low >= 128 and low - 256 or low)
      end
    end
  end
  if number:uint() <= 2 and not detail then name = "SYNC" .. number:uint() .. " or " .. name end
  return name, detail
end

local function add_sonar(r, tree)
  local count = r.add(tree, a["sip.sonar_count"], 1)
  if not count then return true end
  if count:uint() > 32 or r.left() < 3 * count:uint() then return false end
  for _ = 1, count:uint() do
    local index, range = r.range(1), r.range(2)
    tree:add_le(a["sip.sonar"], range):prepend_text("[" .. index:uint() .. "] ")
  end
  return true
end

local sip_tail = {
  { "gripper", 1 }, { "analog_port", 1 }, { "analog", 1 }, { "digital_in", 1 }, { "digital_out", 1 }, { "battery_x10", 2 },
  { "charge_state", 1 }, { "turn_rate", 2 }, { "faults", 2 }, { "lateral", 2 }, { "temperature", 1 }, { "charge", 1 }, { "time", 4 }, { "flags3", 4 },
}

local function add_sip(tvb, tree, last)
  local r = reader(tvb, 3, last)
  local type = r.range(1)
  if last - 3 < 18 then return nil end -- up to the flags (A6)
  flag(tree, a["sip.moving"], type, type:uint() == 0x33)
  for _, field in ipairs({ { "x", 2 }, { "y", 2 }, { "heading", 2 }, { "left", 2 }, { "right", 2 }, { "battery", 1 } }) do
    r.add(tree, a["sip." .. field[1]], field[2])
  end
  for _, side in ipairs({ { "left_stall", "rear_bumpers" }, { "right_stall", "front_bumpers" } }) do
    local stall = r.range(1)
    flag(tree, a["sip." .. side[1]], stall, stall:uint() % 2 == 1)
    tree:add(a["sip." .. side[2]], stall, rshift(stall:uint(), 1))
  end
  r.add(tree, a["sip.control"], 2)
  local flags = r.add(tree, a["sip.flags"], 2)
  flag(tree, a["sip.motors"], flags, band(flags:le_uint(), 0x01) ~= 0)
  flag(tree, a["sip.stop_button"], flags, band(flags:le_uint(), 0x20) ~= 0)
  flag(tree, a["sip.estall"], flags, band(flags:le_uint(), 0x40) ~= 0)
  if r.left() > 0 then r.add(tree, a["sip.compass"], 1) end
  if r.left() > 0 and not add_sonar(r, tree) then
    tree:add_tvb_expert_info(a_short, tvb(3, last - 3), "The sonar count promises more readings than came")
    return "SIP"
  end
  for _, field in ipairs(sip_tail) do
    if r.left() < field[2] then break end
    r.add(tree, a["sip." .. field[1]], field[2])
  end
  return "SIP"
end

-- In wire order (A10): s text, b byte, w word, i signed word.
local config_fields = {
  "s type", "s subtype", "s serial number", "b 4MOTS", "w ROTVELTOP", "w TRANSVELTOP", "w ROTACCTOP", "w TRANSACCTOP", "w PWMMAX", "s name",
  "b SIPCYCLE", "b HOSTBAUD", "b AUX1BAUD", "w HASGRIPPER", "w FRONTSONAR", "b REARSONAR", "w LOWBATTERY", "w REVCOUNT", "w WATCHDOG",
  "b P2MPACS", "w STALLVAL", "w STALLCOUNT", "w JOYVEL", "w JOYRVEL", "w ROTVELMAX", "w TRANSVELMAX", "w ROTACC", "w ROTDECEL", "w ROTKP",
  "w ROTKV", "w ROTKI", "w TRANSACC", "w TRANSDECEL", "w TRANSKP", "w TRANSKV", "w TRANSKI", "b FRONTBUMPS", "b REARBUMPS", "b CHARGER",
  "b SONARCYCLE", "b AUTOBAUD", "b HASGYRO", "i DRIFTFACTOR", "b AUX2BAUD", "b AUX3BAUD", "w TICKSMM", "w SHUTDOWNVOLTS", "s version",
  "w GYROCW", "w GYROCCW", "b KINEMATICSDELAY", "w LATVELTOP", "w LATACCTOP", "w LATVELMAX", "w LATACC", "w LATDECEL", "w CHARGETHRESH",
  "b PDBPORT", "w GYRORATELIMIT", "b HIGHTEMP", "w POWERBITS", "b BATTERYTYPE", "w SOCLOW", "w SOCSHUTDOWN",
}

local function add_config(tvb, tree, last)
  local r = reader(tvb, 4, last)
  for i, field in ipairs(config_fields) do
    local kind, label = field:match("^(%a) (.+)$")
    if r.left() == 0 then return i > 2 and "CONFIGpac" or nil end -- a firmware stops where it stops
    if kind == "s" then
      local range, text = r.text()
      if not range then return i > 2 and "CONFIGpac" or nil end
      tree:add(a["config.text"], range, text):set_text(label .. ": " .. text)
    else
      local range = r.range(kind == "b" and 1 or 2)
      if not range then return "CONFIGpac" end
      local value = kind == "i" and range:le_int() or range:le_uint()
      tree:add(a["config.number"], range, value):set_text(label .. ": " .. value)
    end
  end
  return "CONFIGpac"
end

local function add_identity(tvb, tree, last)
  local r = reader(tvb, 4, last)
  local found = {}
  for _, field in ipairs({ "robot_name", "robot_type", "robot_subtype" }) do
    local range, text = r.text()
    if not range then return nil end
    found[#found + 1] = { a[field], range, text }
  end
  for _, one in ipairs(found) do tree:add(one[1], one[2], one[3]) end
  return "SYNC2 reply"
end

local function add_encoder(tvb, tree, last)
  if last - 4 < 8 then return nil end
  tree:add_le(a["encoder.left"], tvb(4, 4))
  tree:add_le(a["encoder.right"], tvb(8, 4))
  return "ENCODERpac"
end

local function add_gyro(tvb, tree, last)
  local r = reader(tvb, 4, last)
  local count = r.range(1)
  if not count or r.left() < 3 * count:uint() then return nil end
  for _ = 1, count:uint() do
    r.add(tree, a["gyro.rate"], 2)
    r.add(tree, a["gyro.temperature"], 1)
  end
  return "GYROpac"
end

local function add_io(tvb, tree, last)
  local r = reader(tvb, 4, last)
  for _, group in ipairs({ { "digital_in", 1 }, { "digital_out", 1 }, { "analog", 2 } }) do
    local count = r.range(1)
    if not count or r.left() < group[2] * count:uint() then return nil end
    for _ = 1, count:uint() do r.add(tree, a["io." .. group[1]], group[2]) end
  end
  return "IOpac"
end

local readers = { [0x02] = add_identity, [0x20] = add_config, [0x32] = add_sip, [0x33] = add_sip, [0x90] = add_encoder, [0x98] = add_gyro, [0xF0] = add_io }

local function add_arcos(tvb, direction, tree)
  local last = tvb:len() - 2 -- where the checksum begins
  local item = tree:add(arcos, tvb())
  item:add(a.count, tvb(2, 1))
  local type = tvb(3, 1):uint()
  local name, detail
  if direction == OUT then
    name, detail = add_command(tvb, item, last)
  elseif readers[type] then
    item:add(a.type, tvb(3, 1))
    name = readers[type](tvb, item, last)
    local is_bare_echo = type == 2 and last == 4
    if not name and not is_bare_echo then item:add_tvb_expert_info(a_short, tvb(3, last - 3)) end
  end
  if not name then
    name = direction == IN and type_names[type] or kUnknownPacket
    if last > 4 then item:add(a.data, tvb(4, last - 4)) end
  end
  item:add(a.checksum, tvb(last, 2))
  item:add(a.name, tvb(3, 1), name)
  item:set_text("ARCOS " .. name .. (detail or ""))
  return name, detail
end

-- LMS2xx --------------------------------------------------------------------------------------------------------------

local telegram_names = {
  [0x10] = "reset", [0x20] = "set mode", [0x30] = "request scan", [0x31] = "request status", [0x32] = "request errors",
  [0x35] = "request counters", [0x36] = "request mean scan", [0x37] = "request sub-range", [0x3A] = "request type", [0x3B] = "set variant",
  [0x3F] = "request mean sub-range", [0x66] = "set permanent baud", [0x74] = "read configuration", [0x77] = "write configuration",
  [0x7B] = "read configuration 2", [0x90] = "power-on", [0x91] = "reset confirmed", [0x92] = "refused", [0xA0] = "mode", [0xB0] = "scan",
  [0xB1] = "status", [0xB2] = "errors", [0xB5] = "counters", [0xB6] = "mean scan", [0xB7] = "sub-range", [0xBA] = "type", [0xBB] = "variant",
  [0xBF] = "mean sub-range", [0xE6] = "permanent baud", [0xF4] = "configuration", [0xF5] = "ranges with reflectivity",
  [0xF7] = "configuration written", [0xFB] = "configuration 2",
}
local mode_names = {
  [0x00] = "installation", [0x10] = "diagnostic", [0x24] = "stream of all values", [0x25] = "on request", [0x26] = "stream of means",
  [0x27] = "stream of a sub-range", [0x28] = "stream of means of a sub-range", [0x2A] = "stream of partial scans",
  [0x2B] = "stream of ranges with reflectivity", [0x30] = "test of the password", [0x40] = "38400 baud", [0x41] = "19200 baud",
  [0x42] = "9600 baud", [0x48] = "500000 baud",
}
local bauds = { [0x8001] = 500000, [0x8019] = 38400, [0x8033] = 19200, [0x8067] = 9600 }

-- Bits of a range, and the first code that is none (B4).
local codings = {
  [0x00] = { 0x1FFF, 0x1FF7 }, [0x01] = { 0x1FFF, 0x1FF7 }, [0x02] = { 0x1FFF, 0x1FF7 }, [0x03] = { 0x3FFF, 0x3FF7 }, [0x04] = { 0x3FFF, 0x3FF7 },
  [0x05] = { 0x7FFF, 0x7FF7 }, [0x06] = { 0x7FFF, 0x7FF7 }, [0x0F] = { 0xFFFF, 0x7FF7 },
}
local code_names = { [0] = "beyond maximum", [3] = "channel 1 error", [4] = "signal too weak", [6] = "overflow", [7] = "dazzled", [8] = "not valid" }
local metres = { [0] = 0.01, [1] = 0.001, [2] = 0.1 }
local unit_names = { [0] = "cm", [1] = "mm", [2] = "10 cm", [3] = "unknown" }

local function add_word(tree, range, scale, coding)
  local word = range:le_uint()
  if not coding or not scale then
    tree:add_le(l.word, range)
    return
  end
  local value = band(word, coding[1])
  if value >= coding[2] or value == 0 then
    local code = value == 0 and "not valid" or code_names[value - coding[2]] or "code"
    tree:add_le(l.word, range):append_text(" (" .. code .. ")")
  else
    tree:add_le(l.word, range)
    tree:add(l.range, range, value * scale)
  end
end

-- Head word, words, and indices where they are sent (B6). Answers false where they do not fit.
local function add_values(r, tree, mode, exact)
  local head = r.range(2)
  if not head then return false end
  local word = head:le_uint()
  local count, unit, partial = band(word, 0x3FF), rshift(word, 14), band(word, 0x2000) ~= 0
  if r.left() < 2 * count or unit == 3 then return false end
  if exact and r.left() ~= 2 * count and r.left() ~= 2 * count + 2 then return false end
  tree:add(l.values, head, count)
  tree:add(l.unit, head, unit_names[unit])
  tree:add(l.partial, head, partial)
  if partial then tree:add(l.partial_number, head, band(rshift(word, 11), 3)) end
  if count > 0 then
    local all = r.range(2 * count)
    local list = tree:add(all, "Values: " .. count)
    for i = 0, count - 1 do add_word(list, all(2 * i, 2), metres[unit], codings[mode or -1]) end
  end
  if exact and r.left() == 2 then
    r.add(tree, l.scan_index, 1)
    r.add(tree, l.telegram_index, 1)
  end
  return true
end

local function add_configuration(range, tree)
  local bytes = range:len()
  if bytes >= 2 then tree:add_le(l.blanking, range(0, 2)) end
  if bytes >= 5 then
    tree:add(l.availability, range(4, 1))
    tree:add(l.indices, range(4, 1), band(range(4, 1):uint(), 2) ~= 0)
  end
  if bytes >= 6 then tree:add(l.measuring_mode, range(5, 1)) end
  if bytes >= 7 then tree:add(l.units, range(6, 1), range(6, 1):uint() == 0 and "cm" or "mm") end
  if bytes >= 10 then tree:add(l.evaluations, range(9, 1)) end
  if bytes >= 11 then tree:add(l.restart_mode, range(10, 1)) end
  tree:add(l.data, range)
end

-- Offsets of B5 count from the response byte, which is byte 4.
local function add_status(tvb, tree)
  local function at(offset, size) return tvb(4 + offset, size) end
  tree:add(l.version, at(1, 7))
  tree:add(l.operating_mode, at(8, 1))
  tree:add(l.fault, at(9, 1))
  for i = 0, 7 do tree:add_le(l.pollution, at(19 + 2 * i, 2)) end
  tree:add_le(l.motor, at(67, 2))
  tree:add(l.measuring_mode, at(102, 1))
  tree:add_le(l.angle, at(107, 2))
  tree:add_le(l.resolution, at(109, 2))
  tree:add(l.restart_mode, at(111, 1))
  tree:add(l.baud, at(116, 2), bauds[at(116, 2):le_uint()] or 0)
  tree:add(l.evaluations, at(118, 1))
  tree:add(l.permanent, at(119, 1), at(119, 1):uint() ~= 0)
  tree:add(l.units, at(122, 1), at(122, 1):uint() == 1 and "mm" or "cm")
  tree:add(l.laser_on, at(123, 1), at(123, 1):uint() ~= 0)
  tree:add(l.boot_version, at(124, 7))
end

-- Each answers whether the content fits. `r` stands behind the response, `last` where the status byte stands.
local replies = {
  [0xB0] = function(r, tree, mode) return add_values(r, tree, mode, true) end,
  [0xB6] = function(r, tree, mode) return r.add(tree, l.mean_of, 1) and add_values(r, tree, mode, true) end,
  [0xB7] = function(r, tree, mode) return r.add(tree, l.from, 2) and r.add(tree, l.to, 2) and add_values(r, tree, mode, true) end,
  [0xBF] = function(r, tree, mode)
    return r.add(tree, l.mean_of, 1) and r.add(tree, l.from, 2) and r.add(tree, l.to, 2) and add_values(r, tree, mode, true)
  end,
  [0xF5] = function(r, tree, mode)
    local count = r.range(2)
    if not count then return false end
    for _ = 1, count:le_uint() do
      local head = r.add(tree, l.from, 2) and r.add(tree, l.to, 2) and r.left() >= 2
      local before = r.left()
      if not head or not add_values(r, tree, mode, false) then return false end
      for _ = 1, (before - 2 - r.left()) / 2 do
        if not r.add(tree, l.reflectivity, 1) then return false end
      end
    end
    return r.left() == 0
  end,
  [0xB1] = function(r, tree, _, tvb)
    if r.left() ~= 152 then return false end
    add_status(tvb, tree)
    return true
  end,
  [0xB2] = function(r, tree)
    while r.left() >= 2 do
      r.add(tree, l.error_type, 1)
      r.add(tree, l.error_number, 1)
    end
    return r.left() == 0
  end,
  [0xB5] = function(r, tree)
    local hours = r.range(2)
    if hours then tree:add(l.hours, hours, 2 * hours:le_uint()) end
    return hours and r.add(tree, l.switch_ons, 2)
  end,
  [0xBB] = function(r, tree)
    local accepted = r.range(1)
    if accepted then tree:add(l.accepted, accepted, accepted:uint() == 1) end
    return accepted and r.add(tree, l.angle, 2) and r.add(tree, l.resolution, 2)
  end,
  [0xA0] = function(r, tree)
    local result = r.range(1)
    if result then tree:add(l.accepted, result, result:uint() == 0) end
    return result
  end,
  [0xE6] = function(r, tree)
    local accepted, setting = r.range(1), r.range(1)
    if setting then
      tree:add(l.accepted, accepted, accepted:uint() == 1)
      tree:add(l.permanent, setting, setting:uint() == 1)
    end
    return setting
  end,
  [0xF4] = function(r, tree)
    local range = r.range(34)
    if range then add_configuration(range, tree) end
    return range
  end,
  [0xF7] = function(r, tree)
    local accepted, range = r.range(1), r.range(34)
    if range then
      tree:add(l.accepted, accepted, accepted:uint() == 1)
      add_configuration(range, tree)
    end
    return range
  end,
}
local function add_text(r, tree)
  if r.left() > 0 then tree:add(l.text, r.range(r.left())) end
  return true
end
replies[0x90], replies[0xBA] = add_text, add_text

local function add_selection(r, tree, has_mean, ranges)
  if has_mean then r.add(tree, l.mean_of, 1) end
  for _ = 1, ranges do
    if not (r.add(tree, l.from, 2) and r.add(tree, l.to, 2)) then return false end
  end
  return true
end

local requests = {
  [0x20] = function(r, tree)
    local mode = r.add(tree, l.mode, 1)
    if not mode then return false end
    local value = mode:uint()
    local meaning = mode_names[value] or "mode " .. value
    tree:add(l.meaning, mode, meaning)
    if value == 0x00 or value == 0x30 then
      if r.left() > 0 then tree:add(l.password, r.range(r.left())) end
    elseif value == 0x26 or value == 0x27 or value == 0x28 then
      return add_selection(r, tree, value ~= 0x27, value == 0x26 and 0 or 1), meaning
    elseif value == 0x2B then
      local count = r.range(2)
      return count and add_selection(r, tree, false, count:le_uint()), meaning
    end
    return true, meaning
  end,
  [0x30] = function(r, tree) return r.add(tree, l.mode, 1) end,
  [0x36] = function(r, tree) return add_selection(r, tree, true, 0) end,
  [0x37] = function(r, tree) return add_selection(r, tree, false, 1) end,
  [0x3F] = function(r, tree) return add_selection(r, tree, true, 1) end,
  [0x3B] = function(r, tree) return r.add(tree, l.angle, 2) and r.add(tree, l.resolution, 2) end,
  [0x66] = function(r, tree)
    local setting = r.range(1)
    if setting then tree:add(l.permanent, setting, setting:uint() == 1) end
    return setting
  end,
  [0x77] = function(r, tree)
    local size = r.left()
    if size == 0 or size > 34 then return false end
    add_configuration(r.range(size), tree)
    return true
  end,
}

-- What the laser says of its measuring mode: scans do not tell it (B4).
local function learn_mode(raw, interface)
  local response = raw:byte(5)
  if response == 0x90 then modes[interface] = nil end
  if response == 0xB1 and #raw == 160 then modes[interface] = raw:byte(4 + 102 + 1) end
  if response == 0xF4 and #raw >= 42 then modes[interface] = raw:byte(6 + 5) end
  if response == 0xF7 and #raw >= 43 then modes[interface] = raw:byte(7 + 5) end
end

local function add_lms(tvb, direction, tree, mode)
  if tvb:len() == 1 then
    local name = tvb(0, 1):uint() == 0x06 and "ACK" or "NAK"
    tree:add(lms, tvb(), "LMS2xx " .. name):add(l.name, tvb(0, 1), name)
    return name
  end
  local item = tree:add(lms, tvb())
  local code = tvb(4, 1):uint()
  local name = telegram_names[code] or "command " .. code
  local last = tvb:len() - (direction == IN and 3 or 2)
  item:add(l.address, tvb(1, 1))
  item:add_le(l.length, tvb(2, 2))
  item:add(direction == IN and l.response or l.command, tvb(4, 1))
  local add = (direction == IN and replies or requests)[code]
  local meaning
  if add then
    local fits, told = add(reader(tvb, 5, last), item, mode, tvb)
    if not fits then item:add_tvb_expert_info(l_short, tvb(4, last - 4)) end
    meaning = told
  elseif last > 5 then
    item:add(l.data, tvb(5, last - 5))
  end
  if direction == IN then
    local status = tvb(last, 1)
    item:add(l.status, status)
    item:add(l.severity, status, band(status:uint(), 0x07))
    item:add(l.implausible, status, band(status:uint(), 0x40) ~= 0)
    item:add(l.dirty, status, band(status:uint(), 0x80) ~= 0)
  end
  item:add_le(l.crc, tvb(tvb:len() - 2, 2))
  item:add(l.name, tvb(4, 1), name)
  local detail = meaning and ": " .. meaning or ""
  item:set_text("LMS2xx " .. name .. detail)
  return name, detail
end

-- Packets -------------------------------------------------------------------------------------------------------------

local function add_notes(tvb, tree, told)
  for _, note in ipairs(told) do
    local shown = #note > 200 and note:sub(1, 200) .. " ..." or note
    tree:add(notes, tvb(), "Note: " .. shown):add(f_note, note)
  end
end

local function info_of(names, told, waiting)
  local parts = {}
  for _, name in ipairs(names) do parts[#parts + 1] = name end
  for _, note in ipairs(told) do parts[#parts + 1] = "[" .. (#note > 80 and note:sub(1, 80) .. " ..." or note) .. "]" end
  if #parts == 0 then parts[1] = "part of a frame" end
  if waiting > 0 and #names > 0 then parts[#parts + 1] = "begin of another" end
  return table.concat(parts, ", ")
end

-- One packet of the recording. `device`: the interface's name; `add`: shows a frame and answers its name.
local function dissect(proto, device, fields, garbage_expert, size_of, add, tvb, pinfo, tree)
  local told = notes_of()
  local id = interface_id()
  local interface = device .. (id and id.value or 0)
  local is_new = not completed[pinfo.number]
  local items = items_of(tvb, pinfo, interface, size_of, told)
  local names = {}
  for _, item in ipairs(items) do
    local bytes = bytes_of(item, items, tvb, "Put together: " .. #item.raw .. " bytes of " .. device)
    if item.is_garbage then
      local shown = tree:add(proto, bytes(), device .. ": garbage, " .. #item.raw .. " bytes")
      shown:add(fields.garbage, bytes())
      shown:add_tvb_expert_info(garbage_expert, bytes())
      names[#names + 1] = "garbage"
    else
      if is_new and device == "laser" and items.direction == IN then
        learn_mode(item.raw, interface)
        item.mode = modes[interface]
      end
      local name, detail = add(bytes, items.direction, tree, item.mode)
      names[#names + 1] = name .. (detail or "")
    end
  end
  if #items == 0 and tvb:len() > 0 then tree:add(proto, tvb(), device .. ": part of a frame, " .. items.waiting .. " bytes so far") end
  add_notes(tvb, tree, told)
  pinfo.cols.protocol = proto.name
  if tvb:len() > 0 then
    pinfo.cols.src = items.direction == IN and device or "host"
    pinfo.cols.dst = items.direction == IN and "host" or device
  end
  pinfo.cols.info = info_of(names, told, items.waiting)
end

-- Other captures use these link types, too: what is not ours goes on to whoever had it before.
local function register(proto, encapsulation, device, ...)
  local encapsulations = DissectorTable.get("wtap_encap")
  local before = encapsulations:get_dissector(encapsulation)
  local parts = { ... }
  function proto.dissector(tvb, pinfo, tree)
    local name = interface_name()
    if name and name.value ~= device then
      if before then before:call(tvb, pinfo, tree) end
      return
    end
    dissect(proto, device, parts[1], parts[2], parts[3], parts[4], tvb, pinfo, tree)
  end
  encapsulations:add(encapsulation, proto)
end

register(arcos, wtap.USER0, "robot", a, a_garbage, arcos_frame_size, add_arcos)
register(lms, wtap.USER1, "laser", l, l_garbage, lms_frame_size, add_lms)
