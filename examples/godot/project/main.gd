# Makes the figure of an OBJ file super-deformed, and shows its steps in a row:
#
#     godot3-server --path project -s main.gd -- FIGURE.obj OUT
#
# OUT gets the vertices of the last step, three 32-bit floats each. Of the file, lines "v x y z" and "f a b c" are read.
extends SceneTree

const STEPS = [0.0, 0.25, 0.5, 0.75, 1.0]

func _init():
	var files = OS.get_cmdline_args()
	files = Array(files).slice(files.size() - 2, files.size() - 1)
	OS.exit_code = 1 if show_steps(files[0], files[1]) != "" else 0
	quit()

func show_steps(from, to):
	var figure = read(from)
	var deform = load("res://superdeform.gdns").new()
	print("no figure: ", deform.open(PoolVector3Array(), PoolVector3Array(), PoolIntArray(), "sd2.5"))
	print("not open: ", deform.apply(1.0))
	var shading = normals(figure[0], figure[1])
	print("no such style: ", deform.open(figure[0], shading, figure[1], "sd9000"))
	print("too few normals: ", deform.open(figure[0], PoolVector3Array([Vector3.UP]), figure[1], "sd2.5"))
	var wrong = deform.open(figure[0], shading, figure[1], "sd2.5")
	for amount in STEPS:
		if wrong == "":
			wrong = deform.apply(amount)
		if wrong != "":
			print("wrong: ", wrong)
			return wrong
		var height = place(deform, figure[1], amount)
		print("amount %.2f: %.6f tall" % [amount, height])
	print(root.get_child_count(), " figures in the scene")
	var file = File.new()
	file.open(to, File.WRITE)
	for vertex in deform.vertices():
		for i in 3:
			file.store_float(vertex[i])
	file.close()
	return ""

# A mesh of the step, beside the others; how tall it is.
func place(deform, triangles, amount):
	var arrays = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = deform.vertices()
	arrays[Mesh.ARRAY_NORMAL] = deform.normals()
	arrays[Mesh.ARRAY_INDEX] = clockwise(triangles)
	var mesh = ArrayMesh.new()
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	var shown = MeshInstance.new()
	shown.mesh = mesh
	shown.translation.x = amount * 10
	root.add_child(shown)
	return mesh.get_aabb().size.y

# The engine shows the side on which a triangle runs clockwise; files have it the other way round.
func clockwise(triangles):
	var turned = triangles
	for i in range(0, turned.size(), 3):
		var other = turned[i]
		turned[i] = turned[i + 1]
		turned[i + 1] = other
	return turned

# One a vertex, of the triangles around it by their areas.
func normals(vertices, triangles):
	var sums = []
	for vertex in vertices:
		sums.append(Vector3.ZERO)
	for i in range(0, triangles.size(), 3):
		var corner = vertices[triangles[i]]
		var area = (vertices[triangles[i + 1]] - corner).cross(vertices[triangles[i + 2]] - corner)
		for k in 3:
			sums[triangles[i + k]] += area
	var made = PoolVector3Array()
	for sum_of_areas in sums:
		made.append(sum_of_areas.normalized())
	return made

func read(path):
	var vertices = PoolVector3Array()
	var triangles = PoolIntArray()
	var file = File.new()
	file.open(path, File.READ)
	while not file.eof_reached():
		var words = file.get_line().split(" ", false)
		if words.size() == 4 and words[0] == "v":
			vertices.append(Vector3(float(words[1]), float(words[2]), float(words[3])))
		if words.size() == 4 and words[0] == "f":
			for i in range(1, 4):
				triangles.append(int(words[i]) - 1)
	file.close()
	return [vertices, triangles]
