-- A camera that sees the whole of a box.
local framing = {}

local function dot(a, b) return a.x * b.x + a.y * b.y + a.z * b.z end

-- low, high: corners in metres. Gives where to stand, the centre to look at, how far that is, and how near to the
-- camera the box comes.
function framing.of_box(low, high, options)
  options = options or {}
  local yaw = math.rad(options.yaw_deg or 35)
  local pitch = math.rad(options.pitch_deg or 15)
  local aspect = options.aspect or 16 / 9
  local tan_y = math.tan(math.rad(options.fov_deg or 45) / 2) / 1.06  -- a little air round the box
  local tan_x = tan_y * aspect

  local back = vec3(math.sin(yaw) * math.cos(pitch), math.sin(pitch), math.cos(yaw) * math.cos(pitch))
  local right = vec3(math.cos(yaw), 0, -math.sin(yaw))
  local up = vec3(-math.sin(pitch) * math.sin(yaw), math.cos(pitch), -math.sin(pitch) * math.cos(yaw))
  local centre = (low + high) / 2
  local half = (high - low) / 2

  -- A corner is in the picture while its offsets are at most (distance - depth) times the half angles' tangents.
  local distance, foremost = 0, 0
  for _, x in ipairs { -1, 1 } do
    for _, y in ipairs { -1, 1 } do
      for _, z in ipairs { -1, 1 } do
        local corner = half * vec3(x, y, z)
        local depth = dot(corner, back)
        distance = math.max(distance, depth + math.abs(dot(corner, right)) / tan_x, depth + math.abs(dot(corner, up)) / tan_y)
        foremost = math.max(foremost, depth)
      end
    end
  end
  if not (distance > 0) then distance = 1 end  -- a box without size
  return centre + back * distance, centre, distance, distance - foremost
end

return framing
